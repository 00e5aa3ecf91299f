// SPDX-License-Identifier: MIT
#include <system_error>

#include "view/window/draw/text.h"
#include "view/window/panel_parts.h"

namespace fragtrace {

void drawRecentFiles(ViewFacts& facts) {
  RecentFiles& seen = facts.recent;
  const std::vector<std::filesystem::path>& files = facts.remembered.recent;
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
    if (placed(facts.places, "recent " + std::to_string(i), ImGui::Selectable(text.c_str())))
      facts.commands.push_back({.command = Command::OpenFile, .file = files[i]});
    ImGui::EndDisabled();
    tip(facts.places, shownText(files[i].string(), kMostLineCharacters) + (seen.gone[i] ? " is gone" : ""));
  }
}

}  // namespace fragtrace
