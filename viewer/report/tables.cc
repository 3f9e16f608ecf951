// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/report/tables.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/sim_time.h"
#include "runs/timeline/delivery.h"
#include "runs/timeline/outcome_classes.h"
#include "runs/timeline/outcome_ledger.h"
#include "runs/timeline/packet_book.h"
#include "runs/timeline/packet_reasons.h"
#include "viewer/report/chart_texts.h"
#include "viewer/report/svg.h"

namespace halocline::clients {
namespace {

std::string percent(std::int64_t part, std::int64_t all) {
  return all == 0 ? "" : fmt::format("{:.1f}", 100.0 * static_cast<double>(part) / static_cast<double>(all));
}

std::string matrix_cell(const PairDelivery& pair, const std::string& from, const std::string& to) {
  const std::string snr = pair.snr_db ? fmt::format("{:.0f}", *pair.snr_db) : "";
  return fmt::format(
      R"(<td class="cell" style="--share:{:.3f}" title="{}"><b>{:.0f}<span class="unit"> %</span>)"
      R"(</b><small>{}/{}</small>{}</td>)",
      pair.share(),
      escaped_xml(fmt::format("{} received {} of {} packets of {}{}", to, pair.received, pair.packets, from,
                              snr.empty() ? "" : "; median SNR " + snr + " dB")),
      100 * pair.share(), pair.received, pair.packets,
      snr.empty() ? "" : "<small>" + with_unit(snr, "dB") + "</small>");
}

std::string ledger_row(const OutcomeClass& c, const std::string& name, std::int64_t count, std::int64_t all) {
  return fmt::format(R"(<tr><td>{} {}</td><td class="number">{}</td><td class="number">{}<span class="unit">)"
                     R"( %</span></td><td class="share"><i class="c-{}" style="width:{}%"></i></td></tr>)"
                     "\n",
                     inline_mark(c), name, count, percent(count, all), c.key, percent(count, all));
}

}  // namespace

std::string link_matrix(const RunTimeline& timeline) {
  std::map<std::pair<std::int32_t, std::int32_t>, PairDelivery> pairs;
  std::vector<std::int32_t> ids;
  for (const PairDelivery& pair : delivery_by_pair(timeline)) {
    pairs[{pair.from_id, pair.to_id}] = pair;
    ids.push_back(pair.from_id);
    ids.push_back(pair.to_id);
  }
  if (pairs.empty()) return "";
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  const std::size_t left_out = ids.size() > kMatrixVehicles ? ids.size() - kMatrixVehicles : 0;
  ids.resize(ids.size() - left_out);
  std::string html = "<div class=\"wide\"><table class=\"matrix\"><tr><th>from \\ to</th>";
  for (const std::int32_t id : ids) html += "<th>" + escaped_xml(timeline.name(id)) + "</th>";
  html += "</tr>\n";
  for (const std::int32_t from : ids) {
    html += "<tr><th>" + escaped_xml(timeline.name(from)) + "</th>";
    for (const std::int32_t to : ids) {
      const auto pair = pairs.find({from, to});
      html += pair != pairs.end() ? matrix_cell(pair->second, timeline.name(from), timeline.name(to))
                                  : "<td></td>";
    }
    html += "</tr>\n";
  }
  html += "</table></div>\n";
  if (left_out > 0) html += fmt::format("<p class=\"quiet\">{} more vehicles are left out.</p>\n", left_out);
  return html;
}

std::string outcome_table(const RunTimeline& timeline, const PacketLinks& links) {
  const OutcomeCounts& counts = timeline.ledger().total();
  const std::int64_t all = sum(counts);
  std::map<std::int8_t, std::int64_t> refused;
  for (const PacketRecord& packet : timeline.packets().all()) {
    if (packet.is_refused()) ++refused[*packet.receipt];
  }
  if (all == 0 && refused.empty()) return "";
  const auto name = [&](std::size_t outcome) {  // link to the first such packet
    const auto first = std::find_if(links.listed().begin(), links.listed().end(), [&](const Loss& loss) {
      return loss.outcome != nullptr && number_of(*loss.outcome) == outcome;
    });
    return first == links.listed().end() ? outcome_name(outcome)
                                         : links.to_row(*first, outcome_name(outcome));
  };
  std::string html = "<table class=\"ledger\">\n";
  for (std::size_t c = 0; c < kOutcomeClasses; ++c) {
    for (std::size_t outcome = 0; outcome < kOutcomes; ++outcome) {
      if (class_of_outcome(outcome) == c && counts[outcome] > 0)
        html += ledger_row(outcome_classes()[c], name(outcome), counts[outcome], all);
    }
  }
  html += fmt::format(
      "<tr class=\"sum\"><td>all</td><td class=\"number\">{}</td>"
      "<td></td><td></td></tr>\n",
      all);
  for (std::size_t reason = 1; reason < kLossReasons; ++reason) {
    if (const std::int64_t lost = timeline.ledger().by_reason()[reason]; lost > 0)
      html += fmt::format("<tr><td>lost to {}</td><td class=\"number\">{}</td><td></td><td></td></tr>\n",
                          loss_reason_name(reason), lost);
  }
  if (const ByteCounts& bytes = timeline.ledger().bytes(); bytes.sent > 0)
    html += fmt::format("<tr><td>bytes right of {}</td><td class=\"number\">{}</td><td></td><td></td></tr>\n",
                        bytes.sent, bytes.good);
  for (const auto& [result, count] : refused)
    html +=
        fmt::format("<tr><td>not transmitted: {}</td><td class=\"number\">{}</td><td></td><td></td></tr>\n",
                    receipt_name(static_cast<std::size_t>(result)), count);
  return html + "</table>\n";
}

std::string loss_table(const RunTimeline& timeline, const PacketLinks& links) {
  if (links.listed().empty()) return "";
  const auto name = [&](std::int32_t id) { return timeline.name(id); };
  std::string rows;
  for (const Loss& loss : links.listed()) {
    const PacketRecord& packet = *loss.packet;
    const std::string title =
        escaped_xml(fmt::format("{}:{}", name(packet.name.source_id), packet.name.sequence));
    rows += fmt::format(R"(<tr id="{}"><td class="number">{:.1f}</td><td>{}</td>)", links.row_id(loss),
                        packet.at().seconds(), links.to_mark(loss, title));
    if (loss.outcome == nullptr) {
      rows += "<td></td><td></td><td>" + refusal(*packet.receipt) + "</td></tr>\n";
      continue;
    }
    const packet_outcome_t& o = *loss.outcome;
    const OutcomeClass& c = outcome_classes()[class_of_outcome(number_of(o))];
    rows += fmt::format("<td>{}</td><td class=\"number\">{:.0f}</td><td>{} {}</td></tr>\n",
                        escaped_xml(name(o.receiver_id)), o.range_m, inline_mark(c),
                        escaped_xml(sentence(o, name)));
  }
  std::string html =
      "<div class=\"wide\"><table class=\"losses\"><tr><th class=\"number\">departure, s</th><th>packet</th>"
      "<th>at</th><th class=\"number\">range, m</th><th>why</th></tr>\n" +
      rows + "</table></div>\n";
  if (links.left_out() > 0)
    html += fmt::format(
        "<p class=\"quiet\">{} more are left out; <code>halocline outcomes LOG --format outcomes</code> has "
        "all.</p>\n",
        links.left_out());
  return html;
}

std::string node_table(const RunTimeline& timeline) {
  std::string rows;
  for (const auto& [name, node] : timeline.health().nodes()) {
    const node_status_t& s = node.status;
    const bool is_sound = s.gaps + s.lost + s.late + s.messages_refused == 0 && node.held_real_time();
    if (is_sound && node.incarnations < 2) continue;
    rows += fmt::format(
        "<tr><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td>"
        "<td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{:.2g}</td>"
        "<td class=\"number\">{}</td></tr>\n",
        escaped_xml(name), s.messages_received, s.gaps, s.repaired, s.lost, s.late, node.lateness_max_s,
        node.incarnations - 1);
  }
  if (rows.empty()) return "";
  return "<table><tr><th>program</th><th class=\"number\">received</th><th class=\"number\">missed</th><th "
         "class=\"number\">"
         "repaired</th><th class=\"number\">lost</th><th class=\"number\">late</th><th "
         "class=\"number\">latest, s</th><th class=\"number\">restarts</th></tr>\n" +
         rows + "</table>\n";
}

}  // namespace halocline::clients
