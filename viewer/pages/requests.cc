// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/pages/requests.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/sim_time.h"
#include "runs/timeline/link_history.h"
#include "runs/timeline/packet_book.h"
#include "runs/timeline/packet_reasons.h"
#include "runs/timeline/vehicle_record.h"
#include "viewer/pages/binary_messages.h"
#include "viewer/pages/link_display.h"
#include "viewer/pages/request_fields.h"
#include "viewer/pages/vehicle_json.h"

namespace halocline::monitor {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxPackets = 5000;

struct Ask {
  const clients::RunTimeline& timeline;
  PacketIndex& packets;
  const json& request;

  std::vector<const clients::PacketRecord*> departing(SimTime from, SimTime to) const {
    packets.refresh(timeline.packets());
    return packets.departing(timeline.packets(), from, to);
  }
};

json answer_packets(const Ask& ask) {
  const TimeWindow window = window_in(ask.request);
  auto found = ask.departing(window.from, window.to);
  const bool truncated = found.size() > kMaxPackets;
  if (truncated) found.erase(found.begin(), found.end() - kMaxPackets);
  return {{"items", packets_json(ask.timeline, found)}, {"truncated", truncated}};
}

json answer_overview(const Ask& ask) {
  constexpr std::int64_t kMaxBins = 400;
  const TimeWindow window = window_in(ask.request);
  const auto bins = static_cast<std::size_t>(integer_in(ask.request, "bins", 1, kMaxBins));
  const double width_s = (window.to - window.from).seconds() / static_cast<double>(bins);
  require(width_s > 0, "to_s is not after from_s");
  std::vector<std::int64_t> sent(bins), received(bins), lost(bins);
  for (const clients::PacketRecord* packet : ask.departing(window.from, window.to)) {
    if (packet->is_refused()) continue;
    const double place = (packet->at() - window.from).seconds() / width_s;
    const std::size_t bin = std::min(static_cast<std::size_t>(place), bins - 1);
    ++sent[bin];
    for (const packet_outcome_t& outcome : packet->outcomes)
      ++(outcome.outcome == packet_outcome_t::RECEIVED ? received : lost)[bin];
    lost[bin] += packet->out_of_reach;
  }
  return {{"sent", sent}, {"received", received}, {"lost", lost}};
}

json answer_tracks(const Ask& ask) {
  return tracks_json(ask.timeline, window_in(ask.request), max_points_in(ask.request));
}

json answer_vehicle(const Ask& ask) {
  return vehicle_series_json(ask.timeline, vehicle_in(ask.timeline, ask.request, "vehicle"),
                             window_in(ask.request), max_points_in(ask.request));
}

json answer_pair(const Ask& ask) {
  constexpr std::size_t kMaxPoints = 2000;
  const auto &from = vehicle_in(ask.timeline, ask.request, "from"),
             &to = vehicle_in(ask.timeline, ask.request, "to");
  const TimeWindow window = window_in(ask.request);
  const std::string key = text_in(ask.request, "column");
  const std::size_t index = find_display(key);
  require(index < link_displays().size(), "there is no column " + key);
  const LinkDisplay& display = link_displays()[index];
  json packets = json::array(), time_s = json::array(), value = json::array();
  for (const clients::PacketRecord* packet : ask.departing(window.from, window.to)) {
    for (const packet_outcome_t& outcome : packet->outcomes) {
      if (outcome.source_id != from.id || outcome.receiver_id != to.id) continue;
      packets.push_back({{"key", packet_key(*packet)},
                         {"depart_s", packet->at().seconds()},
                         {"code", static_cast<int>(outcome.outcome)}});
    }
  }
  const clients::LinkColumn* column = clients::link_column(display.key);
  if (column != nullptr) {
    for (const auto& [at, number] :
         ask.timeline.links().history(from.id, to.id, *column, window.from, window.to, kMaxPoints)) {
      const link_t* row = ask.timeline.links().row_at(from.id, to.id, at);
      time_s.push_back(at.seconds());
      value.push_back(row == nullptr ? json() : json(shown_value(display, *row)));
    }
  }
  return {{"time_s", std::move(time_s)}, {"value", std::move(value)}, {"packets", std::move(packets)}};
}

json answer_row(const Ask& ask) {
  const auto &from = vehicle_in(ask.timeline, ask.request, "from"),
             &to = vehicle_in(ask.timeline, ask.request, "to");
  const SimTime at = SimTime::from_seconds(number_in(ask.request, "time_s", -9e9, 9e9));
  const link_t* row = ask.timeline.links().row_at(from.id, to.id, at);
  json values = json::array();
  for (const LinkDisplay& display : link_displays()) {
    double value = std::numeric_limits<double>::quiet_NaN();
    if (display.key == kReceivedShare) {
      const auto recent = ask.departing(at - kShareWindow, at);
      for (const LinkValue& share : shown_values(ask.timeline, display, at, recent)) {
        if (share.from == from.index && share.to == to.index) value = share.value;
      }
    } else if (row != nullptr) {
      value = shown_value(display, *row);
    }
    values.push_back(value);
  }
  return {{"values", std::move(values)}};
}

json step_json(const clients::LadderStep& step) {
  const char* compare = !step.limit                                            ? nullptr
                        : step.step == "acquisition" || step.step == "success" ? ">"
                                                                               : ">=";
  return {{"step", step.step},
          {"quantity", step.quantity},
          {"value", step.value ? json(*step.value) : json()},
          {"unit", step.unit},
          {"limit", step.limit ? json(*step.limit) : json()},
          {"compare", compare == nullptr ? json() : json(compare)},
          {"passed", step.passed ? json(*step.passed) : json()},
          {"help", step.help}};
}

const packet_outcome_t* outcome_at(const clients::PacketRecord& packet, std::int32_t receiver_id) {
  const auto found =
      std::find_if(packet.outcomes.begin(), packet.outcomes.end(),
                   [&](const packet_outcome_t& outcome) { return outcome.receiver_id == receiver_id; });
  return found == packet.outcomes.end() ? nullptr : &*found;
}

json colliders_json(const Ask& ask, const packet_outcome_t& outcome) {
  constexpr SimDuration kLongest = SimDuration::from_milliseconds(600'000);
  json all = json::array();
  if (outcome.colliders.empty()) return all;
  const SimTime departure = SimTime::from_utime(outcome.departure_utime);
  const auto near = ask.departing(departure - kLongest, clients::end_of(outcome));
  for (const packet_name_t& name : outcome.colliders) {
    const auto found = std::find_if(near.rbegin(), near.rend(), [&](const clients::PacketRecord* packet) {
      return packet->name.source_id == name.source_id && packet->name.sequence == name.packet_sequence;
    });
    const clients::VehicleRecord* source = ask.timeline.find(name.source_id);
    if (found != near.rend() && source != nullptr)
      all.push_back({{"key", packet_key(**found)}, {"source", source->index}});
  }
  return all;
}

json answer_packet(const Ask& ask) {
  const std::string key = text_in(ask.request, "key");
  const auto number = packet_number(key);
  const clients::PacketRecord* packet = number ? ask.timeline.packets().find(*number) : nullptr;
  require(packet != nullptr, "the packet " + key + " is not known, or too old to be kept");
  json reply = {{"key", key},
                {"receiver", nullptr},
                {"code", -1},
                {"ladder", json::array()},
                {"colliders", json::array()}};
  if (packet->is_refused()) {
    reply["sentence"] = clients::refusal(packet->receipt.value_or(0));
    return reply;
  }
  const clients::VehicleRecord& receiver = vehicle_in(ask.timeline, ask.request, "receiver");
  reply["receiver"] = receiver.index;
  const packet_outcome_t* outcome = outcome_at(*packet, receiver.id);
  if (outcome == nullptr) {
    reply["sentence"] = packet->out_of_reach > 0
                            ? receiver.name + " is out of reach, or nothing is decided there yet."
                            : "Not decided yet at " + receiver.name + ".";
    return reply;
  }
  reply["code"] = static_cast<int>(outcome->outcome);
  reply["sentence"] = clients::sentence(*outcome, [&](std::int32_t id) { return ask.timeline.name(id); });
  for (const clients::LadderStep& step : clients::ladder(*outcome))
    reply["ladder"].push_back(step_json(step));
  reply["colliders"] = colliders_json(ask, *outcome);
  return reply;
}

}  // namespace

std::int64_t request_id(const json& request) {
  require(request.is_object(), "a request is an object");
  return integer_in(request, "id", 0, std::int64_t{1} << 53);
}

json answer_request(const clients::RunTimeline& timeline, PacketIndex& packets, const json& request) {
  const Ask ask{timeline, packets, request};
  const std::string what = text_in(request, "ask");
  if (what == "packets") return answer_packets(ask);
  if (what == "overview") return answer_overview(ask);
  if (what == "tracks") return answer_tracks(ask);
  if (what == "vehicle") return answer_vehicle(ask);
  if (what == "pair") return answer_pair(ask);
  if (what == "row") return answer_row(ask);
  if (what == "packet") return answer_packet(ask);
  throw InvalidArgument("there is no request '" + what + "'");
}

}  // namespace halocline::monitor
