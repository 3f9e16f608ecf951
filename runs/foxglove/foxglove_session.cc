// SPDX-License-Identifier: BSD-3-Clause
#include "runs/foxglove/foxglove_session.h"

#include <algorithm>
#include <exception>
#include <utility>
#include <vector>

#include "runs/foxglove/foxglove_messages.h"
#include "runs/foxglove/foxglove_schemas.h"
#include "runs/timeline/packet_book.h"
#include "runs/timeline/vehicle_record.h"

namespace halocline::clients {
namespace {

using nlohmann::json;

constexpr std::uint32_t kSceneChannel = 1, kLogChannel = 2;
constexpr std::size_t kMaxSubscriptions = 2000;
constexpr char kMessageData = 1, kTime = 2;

template <class Number>
void put(std::string& bytes, Number number) {
  for (std::size_t i = 0; i < sizeof(Number); ++i) bytes += static_cast<char>(number >> (8 * i));
}

std::uint64_t nanoseconds(SimTime at) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(at.nanoseconds(), 0));
}

// Returns the packets that are under way at one time, of the latest kMaxRecent.
std::vector<const PacketRecord*> recent(const RunTimeline& timeline, SimTime at) {
  constexpr std::size_t kMaxRecent = 500;
  std::vector<const PacketRecord*> found;
  const auto& all = timeline.packets().all();
  for (std::size_t i = all.size() - std::min(all.size(), kMaxRecent); i < all.size(); ++i) {
    if (all[i].at() <= at && all[i].end() >= at) found.push_back(&all[i]);
  }
  return found;
}

}  // namespace

FoxgloveSession::FoxgloveSession(const std::string& name, Outbox outbox) : outbox_(std::move(outbox)) {
  outbox_(json({{"op", "serverInfo"},
                {"name", name},
                {"capabilities", {"time"}},
                {"supportedEncodings", {"json"}},
                {"metadata", json::object()}})
              .dump(),
          false);
  advertise("/scene", kSceneUpdateSchema.name, kSceneUpdateSchema.json_schema);
  advertise("/log", kLogSchema.name, kLogSchema.json_schema);
}

void FoxgloveSession::advertise(const std::string& topic, std::string_view schema,
                                std::string_view json_schema) {
  const json channel = {{"id", ++last_channel_}, {"topic", topic},        {"encoding", "json"},
                        {"schemaName", schema},  {"schema", json_schema}, {"schemaEncoding", "jsonschema"}};
  outbox_(json({{"op", "advertise"}, {"channels", {channel}}}).dump(), false);
}

void FoxgloveSession::advertise_vehicles(const RunTimeline& timeline) {
  if (!frame_of(timeline)) return;
  for (const VehicleRecord& vehicle : timeline.vehicles()) {
    if (fixes_.contains(vehicle.index)) continue;
    advertise("/vehicles/" + vehicle.name + "/position", kLocationFixSchema.name,
              kLocationFixSchema.json_schema);
    fixes_[vehicle.index] = last_channel_;
  }
}

void FoxgloveSession::tick(double steady_s, bool idle, const RunTimeline& timeline, SimTime at) {
  if (!idle || steady_s - sent_s_ < kPeriod_s || timeline.begin() > timeline.end()) return;
  sent_s_ = steady_s;
  advertise_vehicles(timeline);
  std::string time(1, kTime);
  put(time, nanoseconds(at));
  outbox_(std::move(time), true);
  if (is_subscribed(kSceneChannel))
    send_data(kSceneChannel, at, foxglove_scene(timeline, at, recent(timeline, at)));
  if (const auto frame = frame_of(timeline)) {
    for (const auto& [index, channel] : fixes_) {
      if (!is_subscribed(channel)) continue;
      const json fix = foxglove_fix(timeline.vehicles()[index], *frame, at);
      if (!fix.is_null()) send_data(channel, at, fix);
    }
  }
  if (is_subscribed(kLogChannel)) send_outcomes(timeline, at);
}

void FoxgloveSession::send_outcomes(const RunTimeline& timeline, SimTime at) {
  constexpr std::size_t kMaxRecent = 500;
  const auto& all = timeline.packets().all();
  const SimTime since = std::exchange(outcomes_until_, at);
  if (since == SimTime::at_once() || since > at) return;
  for (std::size_t i = all.size() - std::min(all.size(), kMaxRecent); i < all.size(); ++i) {
    for (const packet_outcome_t& outcome : all[i].outcomes) {
      const SimTime decided = SimTime::from_utime(outcome.utime);
      if (decided > since && decided <= at)
        send_data(kLogChannel, decided, foxglove_log_of(timeline, outcome));
    }
  }
}

void FoxgloveSession::send_data(std::uint32_t channel, SimTime at, const json& message) {
  const std::string payload = message.dump(-1, ' ', false, json::error_handler_t::replace);
  for (const auto& [subscription, subscribed] : subscribed_) {
    if (subscribed != channel) continue;
    std::string bytes(1, kMessageData);
    put(bytes, subscription);
    put(bytes, nanoseconds(at));
    outbox_(bytes + payload, true);
  }
}

bool FoxgloveSession::is_subscribed(std::uint32_t channel) const {
  return std::any_of(subscribed_.begin(), subscribed_.end(),
                     [&](const auto& entry) { return entry.second == channel; });
}

void FoxgloveSession::take(std::string_view message) {
  constexpr int kError = 2;
  try {
    const json request = json::parse(message);
    const std::string op = request.at("op");
    if (op == "subscribe") {
      for (const json& wanted : request.at("subscriptions")) {
        if (subscribed_.size() < kMaxSubscriptions)
          subscribed_[wanted.at("id").get<std::uint32_t>()] = wanted.at("channelId").get<std::uint32_t>();
      }
    } else if (op == "unsubscribe") {
      for (const json& id : request.at("subscriptionIds")) subscribed_.erase(id.get<std::uint32_t>());
    } else {
      outbox_(json({{"op", "status"},
                    {"level", kError},
                    {"message", "this server takes subscribe and unsubscribe"}})
                  .dump(),
              false);
    }
  } catch (const std::exception& problem) {
    outbox_(json({{"op", "status"}, {"level", kError}, {"message", problem.what()}})
                .dump(-1, ' ', false, json::error_handler_t::replace),
            false);
  }
}

}  // namespace halocline::clients
