// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/report/picture.h"

#include <array>

#include <fmt/format.h>

#include "core/check.h"
#include "core/csv_table.h"
#include "runs/plot/plot.h"
#include "viewer/report/svg.h"

namespace halocline::clients {
namespace {

// Colours of the page. gnuplot draws each in a colour that is used for nothing else (#01fe00, #01fe01, ...),
// which is then replaced.
constexpr std::array<std::string_view, 15> kInks{"ink",         "quiet",   "line", "accent", "seabed",
                                                 "seabed-edge", "contour", "v-0",  "v-1",    "v-2",
                                                 "v-3",         "v-4",     "v-5",  "v-6",    "v-7"};

std::string hex_of(std::size_t number) { return fmt::format("#01fe{:02x}", number); }

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

// Removes every part from `begin` to the next `end`, both included.
std::string without(const std::string& text, std::string_view begin, std::string_view end) {
  std::string out;
  std::size_t at = 0;
  for (std::size_t from = 0; (from = text.find(begin, at)) != std::string::npos;) {
    const std::size_t to = text.find(end, from + begin.size());
    if (to == std::string::npos) break;
    out += text.substr(at, from - at);
    at = to + end.size();
  }
  return out + text.substr(at);
}

std::string without_indentation(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool is_space = c == ' ' || c == '\t' || c == '\n';
    if (!is_space || out.empty() || out.back() != '\n') out += c;
  }
  return out;
}

// Removes the empty groups that gnuplot opens for every style, even if nothing is drawn with it.
std::string without_empty_groups(const std::string& svg) {
  std::string out;
  std::size_t at = 0;
  for (std::size_t group = 0; (group = svg.find("<g ", at)) != std::string::npos;) {
    const std::size_t inside = svg.find('>', group) + 1;
    const bool is_empty = svg.compare(inside, 5, "\n</g>") == 0;
    out += svg.substr(at, (is_empty ? group : inside) - at);
    at = is_empty ? inside + 5 : inside;
  }
  return out + svg.substr(at);
}

// Returns gnuplot's drawing without its frame, fonts and names, in the colours of the page.
std::string themed(std::string svg) {
  svg.erase(0, svg.find("<g id=\"gnuplot_canvas\">"));
  svg.resize(svg.rfind("</svg>"));
  svg = without(without(svg, "<defs>", "</defs>"), "<title>", "</title>");
  svg = without(without(svg, " id=\"", "\""), " font-family=\"", "\"");
  svg = without(svg, " font-size=\"", "\"");
  svg = without(svg, " stroke-linecap=\"butt\" stroke-linejoin=\"", "\"");
  for (std::size_t i = 0; i < kInks.size(); ++i) {
    const std::string colour = "var(--" + std::string(kInks[i]) + ")";
    svg = replaced(svg, fmt::format("rgb(  1, 254, {:3})", i), colour);
    svg = replaced(svg, fmt::format("rgb(1,254,{})", i), colour);
    svg = replaced(replaced(svg, hex_of(i), colour), fmt::format("#01FE{:02X}", i), colour);
  }
  svg = replaced(replaced(svg, "xlink:href", "href"), "\"black\"", "\"var(--line)\"");
  svg = replaced(svg, "'black'", "'currentColor'");
  return without_empty_groups(without_indentation(svg));
}

std::string axis_commands(const char* name, const Axis& axis) {
  return fmt::format("set {0}range [{1}:{2}]\nset {0}tics {3} nomirror out scale 0.5\n", name,
                     format_number(axis.low), format_number(axis.high), axis.tics);
}

// Writes the titles of the axes, which gnuplot omits when the margins are given.
std::string axis_titles(const Picture& picture) {
  std::string svg;
  if (!picture.x.title.empty())
    svg += fmt::format(R"(<text x="{}" y="{}" text-anchor="end" class="tick">{}</text>)",
                       px(picture.width_px - picture.right_px), px(picture.height_px - 5),
                       escaped_xml(picture.x.title));
  if (!picture.y.title.empty())
    svg += fmt::format(R"(<text x="0" y="{}" class="tick">{}</text>)", px(picture.top_px - 12),
                       escaped_xml(picture.y.title));
  return svg;
}

}  // namespace

std::string ink(std::string_view variable) {
  for (std::size_t i = 0; i < kInks.size(); ++i) {
    if (kInks[i] == variable) return " lc rgb '" + hex_of(i) + "'";
  }
  throw InvalidArgument("the page has no colour '" + std::string(variable) + "'");
}

std::string drawn(const Picture& picture) {
  const double w = picture.width_px, h = picture.height_px;
  std::string script = fmt::format("set terminal svg size {},{} noenhanced font 'sans,13'\n", px(w), px(h));
  script += fmt::format("set lmargin at screen {}\nset rmargin at screen {}\n",
                        format_number(picture.left_px / w), format_number(1 - picture.right_px / w));
  script += fmt::format("set tmargin at screen {}\nset bmargin at screen {}\n",
                        format_number(1 - picture.top_px / h), format_number(picture.bottom_px / h));
  script += "set border 0\nset tics textcolor rgb '" + hex_of(1) + "'\nunset key\n";
  if (picture.has_grid) script += "set grid back lt 1 lw 0.7" + ink("line") + "\n";
  script += axis_commands("x", picture.x) + axis_commands("y", picture.y) + picture.commands;
  const std::string svg = themed(run_gnuplot(script));
  return fmt::format(R"(<svg viewBox="0 0 {0} {1}" width="{0}" height="{1}" role="img" aria-label="{2}">)",
                     px(w), px(h), escaped_xml(picture.label)) +
         svg + axis_titles(picture) + picture.overlay + "</svg>\n";
}

}  // namespace halocline::clients
