// SPDX-License-Identifier: MIT
#include "bench/report/variants_table.h"

#include <algorithm>

#include "bench/report/formatted.h"

namespace fragtrace {

std::string gainText(const std::vector<double>& withMs, const std::vector<double>& withoutMs) {
  std::vector<double> ratios;
  for (size_t i = 0; i < std::min(withMs.size(), withoutMs.size()); ++i)
    ratios.push_back(withMs[i] / withoutMs[i]);
  if (ratios.empty()) return "-";
  std::ranges::sort(ratios);
  const double low = ratios[ratios.size() / 4];
  const double high = ratios[ratios.size() - 1 - ratios.size() / 4];
  if (low > 1.0) return "saves";
  return high < 1.0 ? "costs" : "no difference";
}

std::string variantsTable(const BenchMachine& machine, const std::vector<FrameSetting>& settings,
                          const std::vector<std::pair<std::string, std::string>>& notForced) {
  if (settings.empty()) return {};
  const FrameSetting& own = settings.front();
  std::string text =
      formatted("%s, %d x %d, by %s, %s\nits own variant: %s\n%.4g ms per frame, compiled in %.4g ms\n\n",
                own.scene.c_str(), own.width, own.height, own.clock.c_str(), machine.glRenderer.c_str(),
                own.variant.c_str(), summarize(own.frameMs).median, own.compileMs);
  text += formatted("%-28s %-24s %-14s %12s %12s %12s  %s\n", "with", "time (least to largest)",
                    "leaving it out", "compile ms", "RMSE", "differing", "picture");
  for (size_t i = 1; i < settings.size(); ++i) {
    const FrameSetting& s = settings[i];
    text += formatted("%-28s %-24s %-14s %12.4g %12.3g %11.3g%%  %s\n", s.configuration.c_str(),
                      ratioText(ratioOf(s.frameMs, own.frameMs)).c_str(),
                      gainText(s.frameMs, own.frameMs).c_str(), s.compileMs, s.picture.rmse,
                      100.0 * s.picture.differing,
                      s.picture.wrong.empty() ? "right" : ("WRONG: " + s.picture.wrong).c_str());
  }
  for (const auto& [name, why] : notForced)
    text += formatted("%-28s not forced: %s\n", name.c_str(), why.c_str());
  return text;
}

}  // namespace fragtrace
