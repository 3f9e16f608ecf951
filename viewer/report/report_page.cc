// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/report/report_page.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <stdexcept>

#include <fmt/format.h>

#include "runs/plot/plot.h"
#include "runs/timeline/outcome_classes.h"
#include "runs/timeline/run_summary.h"
#include "viewer/report/chart_texts.h"
#include "viewer/report/depth_chart.h"
#include "viewer/report/packet_lanes.h"
#include "viewer/report/packet_links.h"
#include "viewer/report/range_chart.h"
#include "viewer/report/run_chart.h"
#include "viewer/report/svg.h"
#include "viewer/report/tables.h"

namespace halocline::clients {
namespace {

constexpr std::size_t kChangesListed = 200;

std::string paragraph(const std::string& text, const char* style = "quiet") {
  return text.empty() ? "" : fmt::format("<p class=\"{}\">{}</p>\n", style, text);
}

// Returns the picture that gnuplot draws, or a paragraph on why it is missing.
std::string picture(const std::function<std::string()>& draw, const char* when_empty) {
  try {
    const std::string svg = draw();
    return svg.empty() ? paragraph(when_empty) : "<div class=\"wide\">" + svg + "</div>\n";
  } catch (const NoGnuplot&) {
    return paragraph(
        "This picture is drawn by gnuplot, which was not installed: <code>apt-get install "
        "gnuplot-nox</code>, "
        "then <code>halocline report LOG</code>.");
  } catch (const std::runtime_error& error) {
    return paragraph(escaped_xml(error.what()), "remark");
  }
}

std::string or_sentence(const std::string& html, const char* when_empty) {
  return html.empty() ? paragraph(when_empty) : html;
}

// Run prepared for the sections of a page.
struct PagePart {
  PagePart(const ReportPart& report_part, const std::string& prefix)
      : part(report_part),
        timeline(part.timeline),
        links(timeline, prefix),
        lanes(packet_lanes(timeline, links)) {}

  const ReportPart& part;
  const RunTimeline& timeline;
  PacketLinks links;
  PacketLanes lanes;
};

// Returns an entry of a legend: a shape in its own colour or that of a vehicle, and its meaning.
std::string sample(const std::string& shape, const std::string& text) {
  return "<span><svg class=\"sample\" viewBox=\"0 0 22 10\" aria-hidden=\"true\">" + shape + "</svg>" + text +
         "</span> ";
}

std::string legend_of(const std::string& samples) { return "<p class=\"legend\">" + samples + "</p>\n"; }

std::string legend() {
  std::string html = "<p class=\"legend\">";
  for (const OutcomeClass& c : outcome_classes())
    html += fmt::format("<span>{} {}</span> ", inline_mark(c), c.label);
  return html + "</p>\n";
}

std::string chart_section(const PagePart& part) {
  const RunTimeline& timeline = part.timeline;
  std::string samples =
      sample(R"(<circle cx="11" cy="5" r="4" class="start"/>)", "start") +
      sample(R"svg(<path d="M0-6L4 4L0 2L-4 4Z" transform="translate(11 6)" class="vehicle"/>)svg",
             "last place and heading") +
      sample(R"(<rect x="7" y="1" width="8" height="8" class="vehicle"/>)", "at rest");
  if (has_details(timeline))
    samples +=
        sample(R"(<circle cx="11" cy="5" r="2.6" class="time"/>)",
               "every " + step_text(time_dots_s(timeline))) +
        sample(R"(<path d="M0 5H22" class="plan"/><rect x="8" y="2" width="6" height="6" class="waypoint"/>)",
               "plan and waypoints");
  std::string caption =
      "Each vehicle has one colour on this page. Dotted lines between vehicles are as wide as the share of "
      "packets received. "
      "Marks beside a track: packets lost there; a click leads to one of them in the list below.";
  if (timeline.terrain()) caption += " Contours in metres, light from the north-west.";
  caption += left_out_tracks(timeline);
  return picture([&] { return run_chart(timeline, part.links); },
                 "No vehicle published a state, so there is no chart.") +
         legend_of(samples) + legend() + paragraph(caption);
}

std::string depth_section(const PagePart& part) {
  const RunTimeline& timeline = part.timeline;
  std::string samples =
      sample(R"(<path d="M0 5H22" class="track"/>)", "depth of the vehicle, in its colour") +
      sample(R"(<path d="M0 5H22" class="commanded"/>)", "commanded depth");
  std::string caption = "Depths in metres below the surface. ";
  if (is_seabed_drawn(timeline))
    samples += sample(R"(<path d="M0 3H22V10H0Z" class="seabed"/><path d="M0 3H22" class="seabed-edge"/>)",
                      "seabed below the vehicle");
  else if (timeline.terrain())
    caption += "The seabed lies far below what is drawn; its depth stands at the left. ";
  return picture([&] { return depth_chart(timeline); }, "No vehicle moved.") + legend_of(samples) +
         paragraph(escaped_xml(caption + left_out_strips(timeline) + resting_vehicles(timeline)));
}

std::string lanes_section(const PagePart& part) {
  const PacketLanes& lanes = part.lanes;
  if (lanes.svg.empty()) return paragraph("The log holds no packets.");
  return "<div class=\"wide\">" + lanes.svg + "</div>\n" + legend() +
         paragraph(
             lanes.note +
             "Upper half of a lane: what the vehicle transmitted, in its colour; lower half: what reached "
             "it, "
             "coloured by its outcome; a thin line is the way of the sound. Hatched: two at once. Rest the "
             "pointer on a bar for the cause; a click on a lost packet leads to its row in the list below.");
}

std::string matrix_section(const PagePart& part) {
  return or_sentence(link_matrix(part.timeline), "No packet had an outcome.") +
         paragraph(
             "Share of the row's packets that the column received, whomever they were addressed to; median "
             "SNR.");
}

std::string range_section(const PagePart& part) {
  return picture([&] { return range_chart(part.timeline); }, "No packet had an outcome.") +
         paragraph(
             "Circles: packets received, with the 95 % interval of as many independent packets. Dashed: the "
             "mean of what the "
             "link tables predicted for the same packets, each alone in the water.");
}

std::string ledger_section(const PagePart& part) {
  return or_sentence(outcome_table(part.timeline, part.links), "No packet had an outcome.") +
         paragraph(
             "One outcome for each packet at each vehicle that could have received it. A cause leads to the "
             "first "
             "packet that it cost.");
}

std::string losses_section(const PagePart& part) {
  return or_sentence(loss_table(part.timeline, part.links), "No packet was lost.");
}

std::string nodes_section(const PagePart& part) {
  return or_sentence(node_table(part.timeline), "Every program received everything.");
}

// Shows the scenario without the files that its configuration carries, which may have megabytes.
std::string scenario_section(const PagePart& part) {
  const std::string& toml = part.timeline.scenario().toml;
  if (toml.empty()) return paragraph("The log does not hold it, and no file lies beside it.");
  const auto files = toml.find("\n[[file]]\n");
  return "<pre>" + escaped_xml(toml.substr(0, files)) + "</pre>\n" +
         (files == std::string::npos ? "" : paragraph("It carries the files that it names."));
}

struct Section {
  const char* id;
  const char* title;
  std::string (*html)(const PagePart& part);
  bool is_folded = false;
  bool is_narrow = false;  // may be placed next to the section before
};

constexpr Section kSections[] = {
    {"chart", "Tracks", chart_section},
    {"matrix", "Who received whom", matrix_section, false, true},
    {"ledger", "What was received and lost, by cause", ledger_section, false, true},
    {"range", "Received against range", range_section, false, true},
    {"depth", "Depth over time", depth_section},
    {"packets", "Packets over time", lanes_section},
    {"losses", "Every packet that was lost, and why", losses_section, true},
    {"programs", "Programs that missed messages or were restarted", nodes_section, true},
    {"scenario", "The scenario", scenario_section, true},
};

std::string facts(const ReportPart& part) {
  const RunTimeline& timeline = part.timeline;
  const RunScenario& scenario = timeline.scenario();
  std::vector<std::string> texts;
  if (timeline.begin() <= timeline.end())
    texts.push_back(time_text(timeline.begin().seconds()) + " to " + time_text(timeline.end().seconds()));
  texts.push_back(fmt::format("{} vehicles", timeline.vehicles().size()));
  if (!scenario.name.empty()) texts.push_back(fmt::format("seed {}", scenario.seed));
  if (const auto& origin = scenario.origin)
    texts.push_back(fmt::format("origin {:.4f}°, {:.4f}°", origin->latitude_deg, origin->longitude_deg));
  if (!timeline.water().empty()) {
    const environment_t& water = timeline.water().front().value;
    texts.push_back(fmt::format("wind {:.1f} m/s", water.wind_speed_mps));
  }
  texts.push_back(part.log);
  std::string html;
  for (const std::string& text : texts) html += (html.empty() ? "" : " · ") + escaped_xml(text);
  return html;
}

std::string heading(const ReportPart& part) {
  const RunScenario& scenario = part.timeline.scenario();
  std::string html = "<h1>" + escaped_xml(scenario.name.empty() ? "A run" : scenario.name) + "</h1>\n";
  html += paragraph(escaped_xml(scenario.description), "lead") + paragraph(facts(part));
  html += "<table class=\"summary\">\n";
  for (const SummaryRow& row : run_summary(part.timeline))
    html += "<tr><th>" + escaped_xml(row.key) + "</th><td>" + escaped_xml(row.text) + "</td></tr>\n";
  html += "</table>\n";
  for (const std::string& remark : part.remarks) html += paragraph(escaped_xml(remark), "remark");
  return html;
}

std::string section_of(const Section& section, const std::vector<PagePart>& parts) {
  std::string content;
  if (parts.size() == 1) {
    content = section.html(parts[0]);
  } else {
    content = "<div class=\"pair\">";
    for (const PagePart& part : parts) content += "<div>" + section.html(part) + "</div>";
    content += "</div>\n";
  }
  if (section.is_folded)
    return fmt::format("<section id=\"{}\"><details><summary><h2>{}</h2></summary>\n{}</details></section>\n",
                       section.id, section.title, content);
  return fmt::format("<section id=\"{}\"{}><h2>{}</h2>\n{}</section>\n", section.id,
                     section.is_narrow && parts.size() == 1 ? " class=\"narrow\"" : "", section.title,
                     content);
}

std::string page(const std::string& title, const std::string& header, const std::vector<PagePart>& parts) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>\n<title>" + escaped_xml(title) +
      "</title>\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<meta name=\"generator\" content=\"halocline report\"/>\n<style>\n" +
      page_style() + "</style></head>\n<body>\n" + mark_definitions() +
      (parts.size() == 1 ? "<main>\n" : "<main class=\"two\">\n") + "<header>" + header + "</header>\n";
  for (const Section& section : kSections) html += section_of(section, parts);
  return html + "</main></body></html>\n";
}

std::string comparison_html(const Comparison& comparison) {
  const auto all = static_cast<std::int64_t>(comparison.rows().size());
  std::string html = fmt::format(
      "<h2>What differs</h2><p>Of {} packets at receivers {} changed their outcome and {} kept it, {} of "
      "them with the same "
      "numbers.</p>\n<table>",
      all, comparison.changed(), all - comparison.changed(), comparison.identical());
  for (const auto& [change, count] : comparison.transitions()) {
    if (change.first != change.second)
      html += fmt::format("<tr><td>{} → {}</td><td class=\"number\">{}</td></tr>\n",
                          escaped_xml(change.first), escaped_xml(change.second), count);
  }
  html += "</table>\n";
  if (comparison.changed() == 0) return html;
  html +=
      "<details><summary>Every change</summary><div class=\"wide\"><table class=\"losses\"><tr><th "
      "class=\"number\">"
      "departure, s</th><th>packet</th><th>at</th><th>before</th><th>after</th><th>why</th></tr>\n";
  std::size_t listed = 0;
  for (const Comparison::Row& row : comparison.rows()) {
    if (!row.changed() || listed++ >= kChangesListed) continue;
    const packet_outcome_t& o = row.any();
    html += fmt::format(
        "<tr><td "
        "class=\"number\">{:.1f}</td><td>{}:{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
        static_cast<double>(o.departure_utime) * 1e-6, escaped_xml(comparison.name(o.source_id)),
        o.packet_sequence, escaped_xml(comparison.name(o.receiver_id)), escaped_xml(row.outcome_before),
        escaped_xml(row.outcome_after), escaped_xml(row.why));
  }
  html += "</table></div>";
  if (listed > kChangesListed)
    html += paragraph(fmt::format("{} more are left out; <code>halocline compare A B</code> has all.",
                                  listed - kChangesListed));
  return html + "</details>\n";
}

std::string title_of(const ReportPart& part) {
  const std::string& name = part.timeline.scenario().name;
  return name.empty() ? part.log : name;
}

}  // namespace

std::string report_page(const ReportPart& part) { return page(title_of(part), heading(part), {{part, ""}}); }

std::string report_page(const ReportPart& before, const ReportPart& after, const Comparison& comparison) {
  return page(title_of(before) + " and " + title_of(after),
              "<div class=\"pair\"><div>" + heading(before) + "</div><div>" + heading(after) +
                  "</div></div>\n" + comparison_html(comparison),
              {{before, "before-"}, {after, "after-"}});
}

}  // namespace halocline::clients
