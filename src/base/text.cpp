// SPDX-License-Identifier: MIT
#include "base/text.h"

#include <numeric>

namespace fragtrace {

namespace {

/// Letters to insert, remove or replace (Levenshtein).
size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t(0));
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i + 1;
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string nearestName(std::string_view unknown, const std::vector<std::string>& known) {
  const size_t letters = unknown.size() - std::min(unknown.find_first_not_of('-'), unknown.size());
  const auto distance = [&](const std::string& name) { return editDistance(unknown, name); };
  const auto nearest = std::ranges::min_element(known, {}, distance);
  const bool isNear = nearest != known.end() && distance(*nearest) <= letters / 3;
  return isNear ? *nearest : std::string();
}

std::vector<size_t> nearestFirst(std::string_view unknown, const std::vector<std::string>& known) {
  const std::string wanted = lowered(std::string(unknown));
  std::vector<std::pair<bool, size_t>> ranks;
  for (const std::string& one : known) {
    const std::string name = lowered(one);
    ranks.emplace_back(name.find(wanted) == std::string::npos, editDistance(wanted, name));
  }
  std::vector<size_t> order(known.size());
  std::iota(order.begin(), order.end(), size_t(0));
  std::ranges::stable_sort(order, {}, [&](size_t i) { return ranks[i]; });
  return order;
}

std::string didYouMean(std::string_view unknown, const std::vector<std::string>& known) {
  const std::string nearest = nearestName(unknown, known);
  return nearest.empty() ? "" : "; did you mean " + nearest + "?";
}

}  // namespace fragtrace
