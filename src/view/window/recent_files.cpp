// SPDX-License-Identifier: MIT
#include "view/window/recent_files.h"

#include <system_error>

#include "view/window/draw/text.h"
#include "view/window/panel_parts.h"

namespace fragtrace {

void drawRecentFiles(RecentFiles& seen, const std::vector<std::filesystem::path>& files, Places& places,
                     Task& task) {
  const int frame = ImGui::GetFrameCount();
  if (frame > seen.frame + 1 || files != seen.files) {
    seen.files = files;
    seen.gone.clear();
    for (const std::filesystem::path& file : files) {
      std::error_code error;
      seen.gone.push_back(!std::filesystem::exists(file, error));
    }
  }
  seen.frame = frame;
  for (size_t i = 0; i < files.size(); ++i) {
    const std::string text =
        shownText(files[i].filename().string(), kMostNameCharacters) + "##" + std::to_string(i);
    ImGui::BeginDisabled(seen.gone[i]);
    if (ImGui::Selectable(text.c_str())) task = {.errand = Errand::OpenFile, .file = files[i]};
    ImGui::EndDisabled();
    addItemPlace(places, "recent " + std::to_string(i));
    tip(places, shownText(files[i].string(), kMostLineCharacters) + (seen.gone[i] ? " is gone" : ""));
  }
}

}  // namespace fragtrace
