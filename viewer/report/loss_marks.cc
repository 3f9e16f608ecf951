// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/report/loss_marks.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include "core/elementary.h"
#include "core/frames.h"
#include "runs/timeline/outcome_classes.h"
#include "runs/timeline/packet_book.h"
#include "runs/timeline/packet_reasons.h"
#include "runs/timeline/vehicle_record.h"
#include "viewer/report/chart_texts.h"
#include "viewer/report/svg.h"

namespace halocline::clients {
namespace {

constexpr double kCell_px = 14;
constexpr std::size_t kMax = 200;  // maximum number of marks: the squares grow until no more are left

// Losses of one class of outcomes in one square.
struct Cluster {
  double x_px = 0, y_px = 0, yaw = 0;  // place and heading of the first loss
  std::int64_t packets = 0;
  Loss shown{};  // first loss that the table lists, otherwise the first
};

// Clusters keyed by square and class of outcomes.
using Clusters = std::map<std::array<int, 3>, Cluster>;

Clusters clusters_of(const RunTimeline& timeline, const PacketLinks& links, const Picture& chart,
                     double cell_px) {
  Clusters clusters;
  for (const PacketRecord& packet : timeline.packets().all()) {
    for (const packet_outcome_t& o : packet.outcomes) {
      const VehicleRecord* receiver = timeline.find(o.receiver_id);
      if (o.outcome == packet_outcome_t::RECEIVED || receiver == nullptr) continue;
      const auto state = state_at(receiver->track, arrival_of(o));
      if (!state) continue;
      const double x = chart.x_px(state->point.position_ned_m.y()),
                   y = chart.y_px(state->point.position_ned_m.x());
      const auto c = static_cast<int>(class_of_outcome(number_of(o)));
      Cluster& cluster = clusters[{c, static_cast<int>(x / cell_px), static_cast<int>(y / cell_px)}];
      const Loss loss{&packet, &o};
      if (cluster.packets++ == 0) {
        cluster = {x, y, state->point.attitude.yaw, 1, loss};
      } else if (!links.has_row(cluster.shown) && links.has_row(loss)) {
        cluster.shown = loss;
      }
    }
  }
  return clusters;
}

}  // namespace

std::string loss_marks(const RunTimeline& timeline, const PacketLinks& links, const Picture& chart) {
  const auto name = [&](std::int32_t id) { return timeline.name(id); };
  std::string svg;
  double cell_px = kCell_px;
  Clusters clusters = clusters_of(timeline, links, chart, cell_px);
  while (clusters.size() > kMax && cell_px < chart.width_px) {
    cell_px *= 1.5;
    clusters = clusters_of(timeline, links, chart, cell_px);
  }
  for (const auto& [key, cluster] : clusters) {
    const OutcomeClass& c = outcome_classes()[static_cast<std::size_t>(key[0])];
    const packet_outcome_t& shown = *cluster.shown.outcome;
    std::string text = packet_title(shown, name) + ". " + sentence(shown, name);
    if (cluster.packets > 1)
      text = fmt::format("{} packets lost here ({}). One of them: {}", cluster.packets, c.label, text);
    const double size = std::min(8 + 2 * elementary::log2(static_cast<double>(cluster.packets)), 16.0);
    // The mark is next to the track, to starboard.
    const double x = cluster.x_px + 11 * elementary::cos(cluster.yaw),
                 y = cluster.y_px + 11 * elementary::sin(cluster.yaw);
    // Most lost packets are out of reach: their dash has no disc, so that the other marks stand out.
    const std::string disc =
        c.mark == std::string_view("dash")
            ? ""
            : fmt::format(R"(<circle cx="{}" cy="{}" r="{}" class="disc"/>)", px(x), px(y), px(size * 0.62));
    svg += links.to_row(cluster.shown,
                        "<g class=\"loss\">" + disc + mark(c, x, y, size) + hover(text) + "</g>") +
           "\n";
  }
  return svg;
}

}  // namespace halocline::clients
