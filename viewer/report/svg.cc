// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/report/svg.h"

#include <cmath>

#include <fmt/format.h>

namespace halocline::clients {
namespace {

bool is_allowed(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte >= 0x20 || c == '\n' || c == '\t';
}

// Returns the number of bytes of the UTF-8 character that begins at `at`; 0 when there is no valid one.
std::size_t character_size(std::string_view text, std::size_t at) {
  const auto byte = static_cast<unsigned char>(text[at]);
  const std::size_t size = byte < 0x80                   ? 1
                           : byte >= 0xc2 && byte < 0xe0 ? 2
                           : byte >= 0xe0 && byte < 0xf0 ? 3
                           : byte >= 0xf0 && byte < 0xf5 ? 4
                                                         : 0;
  if (size == 0 || at + size > text.size()) return 0;
  for (std::size_t i = 1; i < size; ++i) {
    if ((static_cast<unsigned char>(text[at + i]) & 0xc0) != 0x80) return 0;
  }
  return size;
}

}  // namespace

std::string escaped_xml(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t size = character_size(text, i);
    if (size == 1 && text[i] == '&')
      out += "&amp;";
    else if (size == 1 && text[i] == '<')
      out += "&lt;";
    else if (size == 1 && text[i] == '>')
      out += "&gt;";
    else if (size == 1 && text[i] == '"')
      out += "&quot;";
    else if (size == 0 || (size == 1 && !is_allowed(text[i])))
      out += '?';
    else
      out += text.substr(i, size);
    i += size == 0 ? 1 : size;
  }
  return out;
}

std::string px(double value) {
  std::string text = fmt::format("{:.1f}", value);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text == "-0" ? "0" : text;
}

std::string hover(std::string_view text) { return "<title>" + escaped_xml(text) + "</title>"; }

std::string with_unit(std::string_view number, std::string_view unit) {
  return escaped_xml(number) + " <span class=\"unit\">" + escaped_xml(unit) + "</span>";
}

std::string mark_definitions() {
  // Each symbol fills at most 10 by 10 units.
  return R"svg(<svg width="0" height="0" style="position:absolute" aria-hidden="true"><defs>
<symbol id="m-dot" viewBox="0 0 10 10"><circle cx="5" cy="5" r="3.6" fill="currentColor"/></symbol>
<symbol id="m-ring" viewBox="0 0 10 10"><circle cx="5" cy="5" r="3.2" fill="none" stroke="currentColor"
  stroke-width="1.8"/></symbol>
<symbol id="m-cross" viewBox="0 0 10 10"><path d="M1.7 1.7 8.3 8.3M8.3 1.7 1.7 8.3" stroke="currentColor"
  stroke-width="2"/></symbol>
<symbol id="m-bowtie" viewBox="0 0 10 10"><path d="M.8 1.6V8.4L9.2 1.6V8.4Z" fill="currentColor"/></symbol>
<symbol id="m-bar" viewBox="0 0 10 10"><path d="M5 .6V9.4" stroke="currentColor" stroke-width="2.8"/></symbol>
<symbol id="m-dash" viewBox="0 0 10 10"><path d="M1 5H9" stroke="currentColor" stroke-width="2"/></symbol>
<pattern id="hatch" width="4" height="4" patternUnits="userSpaceOnUse" patternTransform="rotate(45)"><path
  d="M0 0V4" class="hatch"/></pattern>
</defs></svg>
)svg";
}

std::string mark(const OutcomeClass& c, double x, double y, double size) {
  return fmt::format(R"(<use href="#m-{}" x="{}" y="{}" width="{}" height="{}" class="c-{}"/>)", c.mark,
                     px(x - size / 2), px(y - size / 2), px(size), px(size), c.key);
}

std::string inline_mark(const OutcomeClass& c) {
  return fmt::format(
      R"(<svg class="mark c-{}" viewBox="0 0 10 10" aria-hidden="true"><use href="#m-{}"/></svg>)", c.key,
      c.mark);
}

}  // namespace halocline::clients
