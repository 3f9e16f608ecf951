// SPDX-License-Identifier: BSD-3-Clause
// Whether a page is well-formed as XML: every element closed in order, attributes quoted, no stray markup.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace halocline::testing {

// Empty, or what is wrong. The document type and comments are skipped.
inline std::string fault_in_xml(std::string_view text) {
  std::vector<std::string> open;
  constexpr std::string_view kName = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_:";
  for (std::size_t at = 0; at < text.size(); ++at) {
    const auto here = [&] { return std::string(text.substr(at > 40 ? at - 40 : 0, 100)); };
    if (text[at] == '&') {
      const auto end = text.find(';', at);
      if (end == std::string_view::npos || end - at > 8) return "a bare & at " + here();
      continue;
    }
    if (text[at] != '<') continue;
    if (text.substr(at).starts_with("<!")) {
      at = text.find('>', at);
      continue;
    }
    const bool closes = text[at + 1] == '/';
    std::size_t i = at + (closes ? 2 : 1);
    const auto name_end = text.find_first_not_of(kName, i);
    const std::string name(text.substr(i, name_end - i));
    if (name.empty()) return "a bare < at " + here();
    for (i = name_end; text[i] != '>' && text[i] != '/';) {
      i = text.find_first_not_of(" \n", i);
      if (text[i] == '>' || text[i] == '/') break;
      const auto begin = text.find_first_not_of(" ", text.find('=', i) + 1);
      const char quote = text[begin];
      if (quote != '"' && quote != '\'') return "an attribute without quotes at " + here();
      i = text.find(quote, begin + 1) + 1;
      if (i == 0) return "an attribute without an end at " + here();
    }
    const bool is_empty = text[i] == '/';
    if (closes) {
      if (open.empty() || open.back() != name) return "</" + name + "> closes nothing at " + here();
      open.pop_back();
    } else if (!is_empty) {
      open.push_back(name);
    }
    at = text.find('>', i);
    if (name == "style" && !closes) at = text.find("</style>", at) - 1;
  }
  return open.empty() ? "" : "<" + open.back() + "> is not closed";
}

}  // namespace halocline::testing
