// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/inbox.h"

#include <algorithm>
#include <cstdint>

#include "bus/messages/channels.h"
#include "bus/transport/subscription.h"
#include "channel_server/links/best_place_service.h"
#include "channel_server/links/link_query_service.h"
#include "channel_server/vehicles/vehicle_noise.h"

namespace halocline::channel_server {
namespace {

namespace channels = bus::channels;

// Largest number of messages of one kind between two steps: one second of a thousand vehicles at 50 Hz.
constexpr std::size_t kMaxMessages = 50'000;
constexpr std::size_t kMaxChanges = 100;

}  // namespace

Inbox::Inbox(bus::Bus& bus, const Shard& shard, const VehicleEquipment& equipment) : bus_(bus) {
  subscribe_equipment(equipment);
  bus_.subscribe<vehicle_state_t>(
      channels::kState,
      [this](std::string_view vehicle, const vehicle_state_t& m) {
        keep(inputs_.states, vehicle, m, channels::kState);
      },
      bus::Wakeup::kStoreOnly);
  bus_.subscribe<modem_config_t>(
      channels::kModem,
      [this](std::string_view vehicle, const modem_config_t& m) {
        keep(inputs_.modems, vehicle, m, channels::kModem);
      },
      bus::Wakeup::kStoreOnly);
  bus_.subscribe<modem_listen_t>(channels::kListen,
                                 [this](std::string_view vehicle, const modem_listen_t& m) {
                                   keep(inputs_.listens, vehicle, m, channels::kListen);
                                 });
  bus_.subscribe<modem_send_t>(channels::kSend, [this](std::string_view vehicle, const modem_send_t& m) {
    keep(inputs_.sends, vehicle, m, channels::kSend);
  });
  subscribe_queries(channels::kLinkQuery, shard, queries_, LinkQueryService::kMaxWaiting);
  subscribe_queries(channels::kBestPlaceQuery, shard, place_queries_, BestPlaceService::kMaxWaiting);
  bus_.subscribe<environment_change_t>(channels::kSetEnvironment, [this](const environment_change_t& m) {
    if (inputs_.changes.size() >= kMaxChanges) {
      return bus_.refuse(channels::kSetEnvironment, "too many changes at once");
    }
    inputs_.changes.push_back(m);
  });
  if (shard.is_alone()) return;
  bus_.subscribe<modem_reply_t>(channels::kModemReply, [this](const modem_reply_t& m) {
    if (inputs_.modem_replies.size() >= kMaxMessages) {
      return bus_.refuse(channels::kModemReply, "too many messages at once");
    }
    inputs_.modem_replies.push_back(m);
  });
}

// Among several servers each answers the queries whose request_id modulo their number is its index.
template <class Query>
void Inbox::subscribe_queries(std::string_view channel, const Shard& shard, std::vector<Query>& queries,
                              std::size_t most) {
  bus_.subscribe<Query>(
      channel, [this, channel, index = shard.index, count = shard.count, &queries, most](const Query& query) {
        if ((query.request_id % count + count) % count != index) return;
        if (queries.size() >= most) return bus_.refuse(channel, "too many queries at once");
        queries.push_back(query);
      });
}

void Inbox::subscribe_equipment(const VehicleEquipment& equipment) {
  if (equipment.clocks.need_fixes()) {
    bus_.subscribe<vehicle_gps_t>(
        channels::kGps,
        [this](std::string_view vehicle, const vehicle_gps_t& m) {
          keep(inputs_.fixes, vehicle, m, channels::kGps);
        },
        bus::Wakeup::kStoreOnly);
  }
  for (const auto& [id, source] : equipment.noise.sources()) {
    if (source.driver != NoiseDriver::kPropeller) continue;
    bus_.subscribe<vehicle_sensors_t>(
        channels::kSensors.of(source.vehicle),
        [this, vehicle = source.vehicle](const vehicle_sensors_t& m) {
          keep(inputs_.sensors, vehicle, m, channels::kSensors);
        },
        bus::Wakeup::kStoreOnly);
  }
  if (equipment.power.has_batteries()) {
    bus_.subscribe<vehicle_battery_t>(
        channels::kBattery,
        [this](std::string_view vehicle, const vehicle_battery_t& m) {
          keep(inputs_.batteries, vehicle, m, channels::kBattery);
        },
        bus::Wakeup::kStoreOnly);
  }
}

template <class Message>
void Inbox::keep(StepInputs::ByVehicle<Message>& messages, std::string_view vehicle, const Message& message,
                 const bus::Family& family) {
  if (messages.size() >= kMaxMessages) return bus_.refuse(family.of(vehicle), "too many messages at once");
  messages.emplace_back(vehicle, message);
}

SimTime Inbox::due() const {
  if (!queries_.empty() || !place_queries_.empty() || !inputs_.changes.empty()) return SimTime::at_once();
  SimTime due = SimTime::never();
  for (const auto& [vehicle, send] : inputs_.sends) due = std::min(due, SimTime::from_utime(send.utime));
  for (const auto& [vehicle, listen] : inputs_.listens)
    due = std::min(due, SimTime::from_utime(listen.utime));
  for (const modem_reply_t& answer : inputs_.modem_replies) {
    due = std::min(due, SimTime::from_nanoseconds(answer.answer_start_ns));
  }
  return due;
}

SimTime Inbox::next_answerable() const {
  SimTime next = SimTime::never();
  for (const auto& [vehicle, send] : inputs_.sends) {
    if (send.packet_kind == modem_send_t::PING || send.wants_ack)
      next = std::min(next, SimTime::from_utime(send.utime));
  }
  return next;
}

void Inbox::forget_after(SimTime latest) {
  const std::int64_t utime = latest.to_utime();
  const auto is_later = [&](const auto& entry) { return entry.second.utime > utime; };
  std::erase_if(inputs_.states, is_later);
  std::erase_if(inputs_.modems, is_later);
  std::erase_if(inputs_.listens, is_later);
  std::erase_if(inputs_.sends, is_later);
  std::erase_if(inputs_.fixes, is_later);
  std::erase_if(inputs_.batteries, is_later);
  std::erase_if(inputs_.sensors, is_later);
  std::erase_if(inputs_.changes, [&](const environment_change_t& change) { return change.utime > utime; });
  inputs_.modem_replies.clear();
}

}  // namespace halocline::channel_server
