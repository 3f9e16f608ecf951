// SPDX-License-Identifier: BSD-3-Clause
#include "tests/layers/prose_rules.h"

#include <cstddef>
#include <regex>
#include <sstream>
#include <string>

namespace halocline::layers {
namespace {

const std::regex kOwn(R"(^\s*//+!?\s*(.*)$)"), kTrailing(R"([;{},)]\s*//!?\s*(\S.*)$)");
const std::regex kBareOwn(
    "^(Of|What|Whether|Where|How|Those|As|By|Which|Who|That|None|Beside|From|With|In|All|The same|Likewise|"
    "Otherwise|Else|Both|Neither|Before|After|At|So|Its|Their)\\b");
const std::regex kBareTrailing(
    "^(of|what|whether|where|how|those|as|by|which|who|that|none|likewise|the same|its|beside)\\b",
    std::regex::icase);

template <class Visit>
void visit_lines(const SourceFile& source, const Visit& visit) {
  std::istringstream lines(source.text);
  int number = 1;
  for (std::string line; std::getline(lines, line); ++number)
    visit(line, source.path + ":" + std::to_string(number) + ": ");
}

void count(const SourceFile& source, Openings& counted) {
  bool follows_a_comment = false;
  visit_lines(source, [&](const std::string& line, const std::string& place) {
    if (line.find("//") == std::string::npos) {
      follows_a_comment = false;
      return;
    }
    std::smatch found;
    const bool is_own = std::regex_match(line, found, kOwn) && line.find("SPDX") == std::string::npos;
    if (is_own && !follows_a_comment) {
      const bool is_bare = std::regex_search(found[1].first, found[1].second, kBareOwn);
      ++counted.own;
      counted.own_bare += is_bare;
      if (is_bare) counted.bare.push_back(place + found.str(1));
    } else if (!is_own && std::regex_search(line, found, kTrailing)) {
      const bool is_bare = std::regex_search(found[1].first, found[1].second, kBareTrailing);
      ++counted.trailing;
      counted.trailing_bare += is_bare;
      if (is_bare) counted.bare.push_back(place + found.str(1));
    }
    follows_a_comment = is_own;
  });
}

}  // namespace

std::vector<std::string> long_lines(const std::vector<SourceFile>& sources) {
  std::vector<std::string> found;
  for (const SourceFile& source : sources) {
    visit_lines(source, [&](const std::string& line, const std::string& place) {
      if (line.size() > kMaxColumns) found.push_back(place + std::to_string(line.size()) + " columns");
    });
  }
  return found;
}

Openings openings(const std::vector<SourceFile>& sources) {
  Openings counted;
  for (const SourceFile& source : sources) count(source, counted);
  return counted;
}

}  // namespace halocline::layers
