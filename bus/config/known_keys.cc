// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bus/config/config_document.h"

namespace halocline::bus {
namespace {

// Edit distance: letters inserted, left out, replaced, or swapped with their neighbour (optimal string
// alignment; Damerau 1964).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before, above(b.size() + 1), row(b.size() + 1);
  std::iota(above.begin(), above.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, replaced});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before = above;
    std::swap(above, row);
  }
  return above[b.size()];
}

// Old names of keys and sections, and the names of today.
constexpr std::array<std::pair<std::string_view, std::string_view>, 1> kRenamedKeys{
    {{"door", "modem_interface"}}};

// Limit between a typing error and another word: one edit in three letters.
std::size_t most_edits(std::string_view key) { return std::max<std::size_t>(1, key.size() / 3); }

}  // namespace

std::string without_indices(const std::string& name) {
  std::string plain;
  bool inside = false;
  for (const char c : name) {
    inside = inside || c == '[';
    if (!inside) plain += c;
    inside = inside && c != ']';
  }
  return plain;
}

// Looks for a new name of the key first, then for the nearest key in the same table, then for the same key in
// another table.
std::string suggestion_for(const ConfigDocument& document, const std::string& prefix, std::string_view key) {
  for (const auto& [old_name, name] : kRenamedKeys) {
    if (key == old_name) return "; it is now " + prefix + std::string(name);
  }
  const auto question = [](const std::string& name) { return "; did you mean " + name + "?"; };
  std::size_t least = most_edits(key) + 1;
  std::string nearest;
  if (const auto table = document.known.find(without_indices(prefix)); table != document.known.end()) {
    for (const std::string& known : table->second) {
      const std::size_t edits = edit_distance(key, known);
      if (edits < least) nearest = known;
      least = std::min(least, edits);
    }
  }
  if (!nearest.empty()) return question(prefix + nearest);
  for (const auto& [table, keys] : document.known) {
    if (keys.contains(key)) return question(table + std::string(key));
  }
  return "";
}

}  // namespace halocline::bus
