// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/pages/command_desk.h"

#include <algorithm>
#include <iterator>
#include <numbers>

#include "bus/messages/channels.h"
#include "bus/messages/message_checks.h"
#include "core/check.h"
#include "core/names.h"
#include "runs/timeline/vehicle_record.h"
#include "viewer/pages/packet_json.h"
#include "viewer/pages/request_fields.h"

namespace halocline::monitor {
namespace {

constexpr double kMaxRpm = 6e6;
// Time within which the bus must show a published SEND.
constexpr double kShown_s = 2;

const clients::VehicleRecord& commanded_vehicle(const clients::RunTimeline& timeline,
                                                const nlohmann::json& request) {
  const clients::VehicleRecord& vehicle = vehicle_in(timeline, request, "vehicle");
  require(is_valid_name(vehicle.name) && vehicle.id != 0,
          "the vehicle " + vehicle.name + " has published no state yet");
  return vehicle;
}

template <class Message>
void require_valid(const Message& message) {
  const std::string problem = bus::problem_in(message);
  require(problem.empty(), problem);
}

const clients::PacketRecord* find(const clients::PacketBook& book, const clients::PacketId& name) {
  constexpr std::ptrdiff_t kMaxRecent = 500;
  const auto first = book.all().end() - std::min(static_cast<std::ptrdiff_t>(book.all().size()), kMaxRecent);
  const auto found = std::find_if(first, book.all().end(),
                                  [&](const clients::PacketRecord& packet) { return packet.name == name; });
  return found == book.all().end() ? nullptr : &*found;
}

}  // namespace

void CommandDesk::command(const clients::RunTimeline& timeline, const nlohmann::json& request) {
  const clients::VehicleRecord& vehicle = commanded_vehicle(timeline, request);
  Command command;
  command.message = {};
  command.message.propeller_rpm = number_in(request, "propeller_rpm", -kMaxRpm, kMaxRpm);
  command.message.rudder_rad = number_in(request, "rudder_rad", -std::numbers::pi, std::numbers::pi);
  command.message.stern_plane_rad =
      number_in(request, "stern_plane_rad", -std::numbers::pi, std::numbers::pi);
  command.message.session = session_;
  command.until_s = now_s_ + number_in(request, "for_s", kPeriod_s, kMaxDuration_s);
  require_valid(command.message);
  commands_[vehicle.name] = command;
}

void CommandDesk::send(const clients::RunTimeline& timeline, const nlohmann::json& request, SimTime now,
                       Sent sent) {
  constexpr std::size_t kMaxBytes = 32768;
  const clients::VehicleRecord& vehicle = commanded_vehicle(timeline, request);
  const auto last = static_cast<std::int64_t>(timeline.vehicles().size()) - 1;
  const std::int64_t destination = integer_in(request, "destination", -1, last);
  const std::string payload = text_in(request, "payload");
  require(payload.size() <= kMaxBytes, "payload has more than 32768 bytes");
  require(destination != static_cast<std::int64_t>(vehicle.index), "a vehicle does not send to itself");
  modem_send_t message{};
  message.utime = now.to_utime();
  message.session = session_;
  message.packet_sequence = next_packet_++;
  message.source_id = vehicle.id;
  message.destination_id =
      destination < 0 ? 0 : timeline.vehicles()[static_cast<std::size_t>(destination)].id;
  message.packet_kind = modem_send_t::DATA;
  message.payload_size = static_cast<std::int32_t>(payload.size());
  message.payload.assign(payload.begin(), payload.end());
  require_valid(message);
  post_(bus::channels::kSend.of(vehicle.name), bus::encoded(message));
  awaited_.push_back({{vehicle.id, modem_send_t::DATA, session_, message.packet_sequence},
                      now_s_ + kShown_s,
                      std::move(sent)});
}

void CommandDesk::tick(double steady_s, const clients::RunTimeline& timeline, SimTime now) {
  now_s_ = steady_s;
  for (auto& [name, command] : commands_) {
    if (command.next_s > now_s_) continue;
    command.next_s = std::max(command.next_s + kPeriod_s, now_s_);
    command.message.utime = now.to_utime();
    command.message.sequence = next_number_[name]++;
    post_(bus::channels::kCommand.of(name), bus::encoded(command.message));
  }
  std::erase_if(commands_, [&](const auto& entry) { return entry.second.until_s <= now_s_; });
  std::vector<Awaited> waiting;
  for (Awaited& awaited : std::exchange(awaited_, {})) {
    const clients::PacketRecord* packet = find(timeline.packets(), awaited.name);
    if (packet == nullptr && awaited.until_s > now_s_)
      waiting.push_back(std::move(awaited));
    else
      awaited.sent(packet == nullptr ? "" : packet_key(*packet));
  }
  awaited_.insert(awaited_.end(), std::make_move_iterator(waiting.begin()),
                  std::make_move_iterator(waiting.end()));
}

}  // namespace halocline::monitor
