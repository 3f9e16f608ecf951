// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/report/packet_lanes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/sim_time.h"
#include "runs/timeline/outcome_classes.h"
#include "runs/timeline/packet_book.h"
#include "runs/timeline/packet_reasons.h"
#include "viewer/report/chart_texts.h"
#include "viewer/report/svg.h"
#include "viewer/report/vehicle_style.h"

namespace halocline::clients {
namespace {

constexpr double kWidth_px = 1120, kLeft_px = 190, kRight_px = 26, kLane_px = 34, kAxis_px = 26,
                 kRowGap_px = 14;
constexpr double kPacket_px = 9;  // least length of a packet of usual duration
constexpr int kRows = 6;          // maximum number of rows

struct Window {
  double begin_s = 0, end_s = 1;
};

class Lanes {
 public:
  Lanes(const RunTimeline& timeline, PacketLinks& links) : timeline_(timeline), links_(links) {}

  PacketLanes drawn() {
    for (const PacketRecord& packet : timeline_.packets().all()) packets_.push_back(&packet);
    std::stable_sort(packets_.begin(), packets_.end(),
                     [](const PacketRecord* a, const PacketRecord* b) { return a->at() < b->at(); });
    if (packets_.empty()) return {};
    choose_lanes();
    choose_window();
    std::string svg;
    for (int row = 0; row < rows_; ++row) svg += row_of(row);
    const double height = rows_ * row_height() - kRowGap_px;
    return {fmt::format(R"(<svg viewBox="0 0 {0} {1}" width="{0}" height="{1}" role="img" aria-label="Time )"
                        R"(line of packets">)",
                        px(kWidth_px), px(height)) +
                svg + "</svg>\n",
            note()};
  }

 private:
  double row_height() const { return static_cast<double>(lanes_.size()) * kLane_px + kAxis_px + kRowGap_px; }

  void choose_lanes() {
    std::map<std::int32_t, std::int64_t> traffic;
    for (const PacketRecord* packet : packets_) {
      traffic[packet->name.source_id] += 1000;
      for (const packet_outcome_t& o : packet->outcomes) ++traffic[o.receiver_id];
    }
    std::vector<std::pair<std::int64_t, std::int32_t>> busiest;
    for (const auto& [id, count] : traffic) busiest.emplace_back(-count, id);
    std::sort(busiest.begin(), busiest.end());
    vehicles_left_out_ = busiest.size() > kLanes ? busiest.size() - kLanes : 0;
    busiest.resize(std::min(busiest.size(), kLanes));
    std::vector<std::int32_t> ids;
    for (const auto& [count, id] : busiest) ids.push_back(id);
    std::sort(ids.begin(), ids.end());
    for (std::size_t i = 0; i < ids.size(); ++i) lanes_[ids[i]] = i;
  }

  void choose_window() {
    std::vector<double> durations_s;
    for (const PacketRecord* packet : packets_) {
      if (packet->departure) durations_s.push_back(packet->duration_s);
    }
    std::sort(durations_s.begin(), durations_s.end());
    const double usual_s = durations_s.empty() ? 1 : std::max(durations_s[durations_s.size() / 2], 1e-3);
    const Window all{std::max(timeline_.begin(), SimTime()).seconds(), timeline_.end().seconds()};
    const double span_s = std::max(all.end_s - all.begin_s, 1.0);
    const double px_per_s = kPacket_px / usual_s, width_px = kWidth_px - kLeft_px - kRight_px;
    const double row_s = width_px / px_per_s;
    rows_ = std::clamp(static_cast<int>(std::ceil(span_s / row_s)), 1, kRows);
    double shown_s = std::min(span_s, rows_ * row_s);
    window_ = {all.begin_s, all.begin_s + shown_s};
    // The busiest interval is the one with the most departures; it is shortened while it holds too many
    // receptions.
    while (true) {
      window_ = busiest(all, shown_s);
      if (receptions_in(window_) <= kLaneMarks || shown_s < 4 * usual_s) break;
      shown_s /= 2;
    }
    is_part_ = shown_s < span_s;
    row_s_ = shown_s / rows_;
  }

  Window busiest(const Window& all, double span_s) const {
    Window best{all.begin_s, all.begin_s + span_s};
    std::size_t most = 0;
    for (std::size_t first = 0, last = 0; first < packets_.size(); ++first) {
      const double begin_s = packets_[first]->at().seconds();
      if (begin_s + span_s > all.end_s + 1e-9 && first > 0) break;
      while (last < packets_.size() && packets_[last]->at().seconds() < begin_s + span_s) ++last;
      if (last - first > most) {
        most = last - first;
        best = {begin_s, begin_s + span_s};
      }
    }
    return span_s >= all.end_s - all.begin_s ? all : best;
  }

  std::size_t receptions_in(const Window& window) const {
    std::size_t count = 0;
    for (const PacketRecord* packet : packets_) {
      const double at_s = packet->at().seconds();
      if (at_s < window.begin_s || at_s > window.end_s) continue;
      for (const packet_outcome_t& o : packet->outcomes) count += lanes_.contains(o.receiver_id) ? 1 : 0;
    }
    return count;
  }

  std::string note() const {
    std::string text;
    if (is_part_)
      text += fmt::format("Shown: {} to {}, the stretch with the most packets of what fits. ",
                          time_text(window_.begin_s), time_text(window_.end_s));
    if (vehicles_left_out_ > 0)
      text += fmt::format("{} vehicles with less traffic are left out. ", vehicles_left_out_);
    return text;
  }

  std::string row_of(int row) {
    row_ = {window_.begin_s + row * row_s_, window_.begin_s + (row + 1) * row_s_};
    top_ = row * row_height();
    std::string svg = axis();
    for (const auto& [id, lane] : lanes_) {
      svg +=
          swatch(timeline_.find(id), 11, lane_y(lane) + 16) +
          fmt::format(R"(<text x="28" y="{}" class="lane">{}</text><path d="M{} {}H{}" class="lane-line"/>)",
                      px(lane_y(lane) + 21), escaped_xml(timeline_.name(id)), px(kLeft_px),
                      px(lane_y(lane) + kLane_px - 2), px(kWidth_px - kRight_px));
    }
    // Thin lines are drawn first, and bars above them.
    std::string flights, bars;
    for (const PacketRecord* packet : packets_) {
      if (packet->at().seconds() > row_.end_s || packet->end().seconds() < row_.begin_s) continue;
      const auto lane = lanes_.find(packet->name.source_id);
      if (lane != lanes_.end()) bars += transmission(*packet, lane->second);
      for (const packet_outcome_t& o : packet->outcomes) {
        if (lanes_.contains(o.receiver_id)) reception({packet, &o}, lane, flights, bars);
      }
    }
    return svg + flights + bars + "\n";
  }

  std::string axis() const {
    const TimeAxis axis =
        time_axis(SimTime::from_seconds(row_.begin_s), SimTime::from_seconds(row_.end_s), 12);
    const double bottom = top_ + static_cast<double>(lanes_.size()) * kLane_px;
    std::string svg;
    for (double t = std::ceil(row_.begin_s / axis.step_s) * axis.step_s; t <= row_.end_s; t += axis.step_s) {
      svg += fmt::format(R"(<path d="M{0} {1}V{2}" class="grid"/>)"
                         R"(<text x="{0}" y="{3}" text-anchor="middle" class="tick">{4:g} {5}</text>)",
                         px(x(t)), px(top_), px(bottom), px(bottom + 16), t / axis.unit_s, axis.unit);
    }
    return svg;
  }

  double x(double t_s) const {
    return kLeft_px + (t_s - row_.begin_s) / (row_.end_s - row_.begin_s) * (kWidth_px - kLeft_px - kRight_px);
  }
  double clamped_x(double t_s) const { return x(std::clamp(t_s, row_.begin_s, row_.end_s)); }
  double lane_y(std::size_t lane) const { return top_ + static_cast<double>(lane) * kLane_px; }

  // Returns `content` with the id of the mark, as a link to its row.
  std::string marked(const Loss& loss, const std::string& classes, const std::string& content) {
    links_.add_mark(loss);
    return fmt::format("<g id=\"{}\"{}>", links_.mark_id(loss), classes) + links_.to_row(loss, content) +
           "</g>";
  }

  std::string transmission(const PacketRecord& packet, std::size_t lane) {
    const double begin_s = packet.at().seconds();
    const std::string title = fmt::format(
        "{}:{} to {} at {}{}", timeline_.name(packet.name.source_id), packet.name.sequence,
        packet.destination_id == 0 ? "all" : timeline_.name(packet.destination_id), time_text(begin_s),
        packet.payload_bytes >= 0 ? fmt::format(", {} bytes", packet.payload_bytes) : "");
    if (packet.is_refused()) {
      if (begin_s < row_.begin_s) return "";
      return marked({&packet, nullptr}, "",
                    fmt::format(R"(<path d="M{} {}l6 10h-12Z" class="refused">{}</path>)", px(x(begin_s)),
                                px(lane_y(lane) + 3), hover(title + ". " + refusal(*packet.receipt))));
    }
    const double left = clamped_x(begin_s), right = clamped_x(begin_s + packet.duration_s);
    if (right <= left) return "";
    return fmt::format(R"(<rect x="{}" y="{}" width="{}" height="13" class="sent {}">{}</rect>)", px(left),
                       px(lane_y(lane) + 2), px(std::max(right - left, 1.5)),
                       classes_of(timeline_.find(packet.name.source_id)),
                       hover(title + fmt::format(", {:.2f} s long", packet.duration_s)));
  }

  void reception(const Loss& loss, std::map<std::int32_t, std::size_t>::const_iterator sender,
                 std::string& flights, std::string& bars) {
    const packet_outcome_t& o = *loss.outcome;
    const OutcomeClass& c = outcome_classes()[class_of_outcome(number_of(o))];
    const double begin_s = arrival_of(o).seconds(), end_s = end_of(o).seconds();
    const double y = lane_y(lanes_.at(o.receiver_id)) + 17, left = clamped_x(begin_s),
                 right = clamped_x(end_s);
    const auto name = [&](std::int32_t id) { return timeline_.name(id); };
    const std::string title = packet_title(o, name) +
                              fmt::format(", arrives after {:.3f} s. ", o.travel_time_s) + sentence(o, name);
    if (right <= left) return;
    const bool has_sound = o.num_paths > 0 && o.outcome != packet_outcome_t::BELOW_CUTOFF;
    const double departure_s = static_cast<double>(o.departure_utime) * 1e-6;
    if (sender != lanes_.end() && has_sound && departure_s >= row_.begin_s)
      flights += fmt::format(R"(<path d="M{} {}L{} {}" class="flight c-{}"/>)", px(x(departure_s)),
                             px(lane_y(sender->second) + 8), px(left), px(y + 6), c.key);
    const double width = std::max(right - left, 1.5);
    const std::string place =
        fmt::format(R"(x="{}" y="{}" width="{}" height="13")", px(left), px(y), px(width));
    const bool is_lost = o.outcome != packet_outcome_t::RECEIVED, begins_here = begin_s >= row_.begin_s;
    std::string bar = hover(title);
    if (!has_sound) {
      bar += fmt::format(R"(<path d="M{} {}h{}" class="faint"/><rect {} class="point"/>)", px(left),
                         px(y + 6.5), px(width), place);
    } else {
      bar += fmt::format(R"(<rect {} class="arrived"/>)", place);
      if (o.outcome == packet_outcome_t::COLLIDED || o.outcome == packet_outcome_t::HALF_DUPLEX)
        bar += fmt::format(R"svg(<rect {} fill="url(#hatch)"/>)svg", place);
      if (is_lost && begins_here) bar += mark(c, left + std::min(width / 2, 8.0), y + 6.5, 10);
    }
    const std::string classes = fmt::format(" class=\"c-{}\"", c.key);
    bars += is_lost && begins_here ? marked(loss, classes, bar) : "<g" + classes + ">" + bar + "</g>";
  }

  const RunTimeline& timeline_;
  PacketLinks& links_;
  std::vector<const PacketRecord*> packets_;   // sorted by departure
  std::map<std::int32_t, std::size_t> lanes_;  // keyed by vehicle id
  std::size_t vehicles_left_out_ = 0;
  Window window_, row_;
  double row_s_ = 1, top_ = 0;
  int rows_ = 1;
  bool is_part_ = false;
};

}  // namespace

PacketLanes packet_lanes(const RunTimeline& timeline, PacketLinks& links) {
  return Lanes(timeline, links).drawn();
}

}  // namespace halocline::clients
