// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/micromodem/micromodem_remote.h"

#include <utility>

#include <fmt/format.h>

#include "clients/modem_gateway/protocols/fields.h"

namespace halocline::modem_gateway {
namespace {

constexpr std::int64_t kMaxMinutes = 8191;  // 13 bits

}  // namespace

bool MicromodemRemote::obey(ClientId client, const NmeaSentence& sentence) {
  if (sentence.id == "CCMEC")
    set_line(client, sentence);
  else if (sentence.id == "CCMSC")
    sleep(client, sentence);
  else
    return false;
  return true;
}

// Refuses a command that must be transmitted to another modem while the transmit queue is full.
bool MicromodemRemote::is_too_busy(ClientId client, std::int64_t destination) const {
  if (destination == core_.own_address() || core_.can_send()) return false;
  core_.refuse(client, NmeaError::kBusy, "transmit queue full");
  return true;
}

// Handles CCMEC,source,destination,line,mode,argument.
void MicromodemRemote::set_line(ClientId client, const NmeaSentence& sentence) {
  const auto n = sentence.numbers<5>();
  if (!n) return core_.refuse_argument(client, sentence);
  const auto [source, destination, line, mode, argument] = *n;
  if (line > kMaxControlLine || mode > kMaxControlMode || argument > kMaxControlArgument)
    return core_.refuse_argument(client, sentence);
  if (is_too_busy(client, destination)) return;
  core_.echo(client, sentence);
  auto packet = control_packet(line, mode, argument);
  if (destination != core_.own_address())
    return send(MicromodemKind::kControl, destination, std::move(packet));
  core_.say_all(fmt::format("CAMER,{},{},{}", destination, destination, control_fields(packet)));
}

// Handles CCMSC,source,destination,minutes. 0 reboots; -1 sleeps until woken, here for kMaxMinutes, the
// longest time that the packet can encode. Further fields are ignored.
void MicromodemRemote::sleep(ClientId client, const NmeaSentence& sentence) {
  const auto n = sentence.numbers<2>();
  const auto asked = integer_in(sentence.field(2), -1, kMaxMinutes);
  if (!n || !asked) return core_.refuse_argument(client, sentence);
  const auto [source, destination] = *n;
  if (is_too_busy(client, destination)) return;
  core_.echo(client, sentence);
  const std::int64_t minutes = *asked < 0 ? kMaxMinutes : *asked;
  if (destination == core_.own_address()) return housekeeping_.sleep(minutes);
  send(MicromodemKind::kSleep, destination,
       {static_cast<std::uint8_t>(minutes >> 8), static_cast<std::uint8_t>(minutes & 255)});
}

void MicromodemRemote::send(MicromodemKind kind, std::int64_t address, std::vector<std::uint8_t> payload) {
  transmitter_.send(
      {MicromodemTransmitter::Kind::kMini, core_.vehicle_of(address), address, std::move(payload)},
      mini_packet(kind));
}

void MicromodemRemote::follow(const modem_receive_t& packet) {
  if (packet.payload.size() != 2) return;
  if (kind_of(packet) == MicromodemKind::kControl)
    send(MicromodemKind::kControlReply, core_.listener().address(packet.source_id), packet.payload);
  if (kind_of(packet) == MicromodemKind::kSleep)
    housekeeping_.sleep(std::int64_t{packet.payload[0]} << 8 | packet.payload[1]);
}

}  // namespace halocline::modem_gateway
