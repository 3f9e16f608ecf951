// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/micromodem/micromodem_receptions.h"

#include <algorithm>
#include <cstddef>
#include <span>

#include <fmt/format.h>

#include "clients/modem_gateway/protocols/fields.h"
#include "core/names.h"
#include "core/text/base64.h"

namespace halocline::modem_gateway {
namespace {

constexpr std::int64_t kToTheSender = 31;

bool is_flexible(const modem_receive_t& packet) {
  const MicromodemKind kind = kind_of(packet);
  return kind == MicromodemKind::kFlexible || kind == MicromodemKind::kFramed ||
         kind == MicromodemKind::kFramedMini;
}

MicromodemPacket type_of(std::int8_t kind, int rate, bool is_flexible) {
  switch (kind) {
    case modem_receive_t::DATA:
      return is_flexible ? MicromodemPacket::kFlexible
             : rate == 0 ? MicromodemPacket::kFsk
                         : MicromodemPacket::kPsk;
    case modem_receive_t::JANUS:
    case modem_receive_t::JANUS_CARGO:
      return MicromodemPacket::kUnknown;
    default:
      return rate == 0 ? MicromodemPacket::kFskMini : MicromodemPacket::kPskMini;
  }
}

MicromodemCycle cycle_of(const Listener& listener, const modem_receive_t& packet) {
  return {0,
          listener.address(packet.source_id),
          listener.address(packet.destination_id),
          packet.rate_number,
          packet.wants_ack,
          packet.num_frames};
}

// Calls `on_frame(index, is_good, bytes)` for each frame, numbered from 0.
template <class OnFrame>
void for_each_frame(const modem_receive_t& packet, const OnFrame& on_frame) {
  std::size_t begin = 0;
  for (std::size_t i = 0; i < packet.frame_bytes.size(); ++i) {
    const auto size = static_cast<std::size_t>(packet.frame_bytes[i]);
    if (begin + size > packet.payload.size()) return;
    const bool is_good = (static_cast<std::uint64_t>(packet.frames_good) >> i & 1) != 0;
    on_frame(i, is_good, std::span(packet.payload).subspan(begin, size));
    begin += size;
  }
}

void add_data(const Listener& listener, const modem_receive_t& packet, std::vector<std::string>& lines) {
  const MicromodemCycle cycle = cycle_of(listener, packet);
  if (packet.rate_number != 0)
    lines.push_back("CACYC," + cycle.fields());  // rate 0: already reported with the cycle packet
  for_each_frame(packet, [&](std::size_t i, bool is_good, std::span<const std::uint8_t> bytes) {
    lines.push_back(is_good ? fmt::format("CARXD,{},{},{},{},{}", cycle.source, cycle.destination,
                                          cycle.wants_ack, i + 1, hex_of(bytes))
                            : fmt::format("CAMSG,BAD_CRC,{}", i + 1));
  });
}

std::string arrival_of(const Listener& listener, const modem_receive_t& packet) {
  return listener.state.clock.iso_us(SimTime::from_utime(packet.arrival_utime));
}

// Appends one of two lines; the rate of data is -1 when there is none:
//
//    CARDP,src,dest,rate,ack,0,mini,data
//    CARFP,time,0,src,dest,rate of the mini-frame,rate of data,ack,0,,mini,data
void add_flexible(const Listener& listener, const modem_receive_t& packet, std::vector<std::string>& lines) {
  std::string mini, data;
  const bool has_mini = kind_of(packet) == MicromodemKind::kFramedMini;
  for_each_frame(packet, [&](std::size_t i, bool is_good, std::span<const std::uint8_t> bytes) {
    std::string& part = has_mini && i == 0 ? mini : data;
    part += fmt::format("{}{};{};{}", part.empty() ? "" : ";", is_good ? 1 : 0, bytes.size(),
                        listener.has_base64 ? base64_of(bytes) : hex_of(bytes));
  });
  const auto source = listener.address(packet.source_id),
             destination = listener.address(packet.destination_id);
  const int ack = packet.wants_ack != 0 ? 1 : 0;
  const bool is_newer = listener.has_newer_lines || kind_of(packet) != MicromodemKind::kFlexible;
  lines.push_back(
      is_newer ? fmt::format("CARFP,{},0,{},{},{},{},{},0,,{},{}", arrival_of(listener, packet), source,
                             destination, packet.rate_number, data.empty() ? -1 : packet.rate_number, ack,
                             mini, data)
               : fmt::format("CARDP,{},{},{},{},0,,{}", source, destination, packet.rate_number, ack, data));
}

void add_mini(const Listener& listener, const modem_receive_t& packet, std::vector<std::string>& lines) {
  const auto source = listener.address(packet.source_id),
             destination = listener.address(packet.destination_id);
  if (kind_of(packet) == MicromodemKind::kPlain)
    return lines.push_back(fmt::format("CAMUA,{},{},{}", source, destination, hex_of(packet.payload)));
  if (kind_of(packet) == MicromodemKind::kControlReply && packet.destination_id == packet.receiver_id)
    lines.push_back(fmt::format("CAMER,{},{},{}", source, destination, control_fields(packet.payload)));
  if (kind_of(packet) != MicromodemKind::kCycle) return;
  if (const auto announced = cycle_in(packet.payload, source, destination))
    lines.push_back("CACYC," + announced->cycle.fields());
}

void add_ping(const Listener& listener, const modem_receive_t& packet, std::vector<std::string>& lines) {
  const auto source = listener.address(packet.source_id),
             destination = listener.address(packet.destination_id);
  if (packet.destination_id != packet.receiver_id) return;
  if (kind_of(packet) != MicromodemKind::kNewPing)
    return lines.push_back(fmt::format("CAMPA,{},{}", source, destination));
  const std::string time = arrival_of(listener, packet);
  // Firmware from version 3 on puts the type before the time.
  lines.push_back(fmt::format("CACMA,{},{},{},{},{:.1f},{:.2f},{},0,0",
                              listener.state.version == kNewestVersion ? "PNG" : time,
                              listener.state.version == kNewestVersion ? time : "PNG", source, destination,
                              packet.snr_db, packet.snr_out_db, listener.state.level));
}

}  // namespace

MicromodemKind kind_of(const modem_receive_t& packet) {
  return static_cast<MicromodemKind>(packet.header_number);
}

std::string MicromodemCycle::fields() const {
  return fmt::format("{},{},{},{},{},{}", command, source, destination, rate, wants_ack, frames);
}

bool can_be_asked_for(const MicromodemCycle& cycle, std::int64_t asker) {
  return cycle.destination == asker || cycle.destination < kToTheSender;
}

std::vector<std::uint8_t> cycle_packet(const MicromodemCycle& cycle, std::optional<std::int64_t> asker) {
  const std::int64_t to = !asker ? 0 : cycle.destination == *asker ? kToTheSender : cycle.destination;
  const std::uint64_t bits = (asker ? 1u : 0u) << 12 | static_cast<std::uint64_t>(to) << 7 |
                             static_cast<std::uint64_t>(cycle.rate & 7) << 4 |
                             static_cast<std::uint64_t>(cycle.wants_ack & 1) << 3 |
                             static_cast<std::uint64_t>((cycle.frames - 1) & 7);
  return {static_cast<std::uint8_t>(bits >> 8), static_cast<std::uint8_t>(bits & 255)};
}

std::optional<CyclePacket> cycle_in(const std::vector<std::uint8_t>& payload, std::int64_t sender,
                                    std::int64_t addressee) {
  if (payload.size() != 2) return std::nullopt;
  const unsigned bits = static_cast<unsigned>(payload[0]) << 8 | payload[1];
  CyclePacket packet;
  packet.asks_for_data = (bits >> 12 & 1) != 0;
  const std::int64_t asked_for = bits >> 7 & 31;
  packet.cycle = {0,
                  packet.asks_for_data ? addressee : sender,
                  !packet.asks_for_data       ? addressee
                  : asked_for == kToTheSender ? sender
                                              : asked_for,
                  bits >> 4 & 7,
                  bits >> 3 & 1,
                  (bits & 7) + 1};
  return packet.cycle.rate < kMicromodemRates ? std::optional(packet) : std::nullopt;
}

std::vector<std::uint8_t> control_packet(std::int64_t line, std::int64_t mode, std::int64_t argument) {
  const std::int64_t bits = line << 9 | mode << 5 | argument;
  return {static_cast<std::uint8_t>(bits >> 8), static_cast<std::uint8_t>(bits & 255)};
}

std::string control_fields(const std::vector<std::uint8_t>& payload) {
  const std::int64_t bits = payload.size() == 2 ? payload[0] << 8 | payload[1] : 0;
  return fmt::format("{},{},{}", bits >> 9 & kMaxControlLine, bits >> 5 & kMaxControlMode,
                     bits & kMaxControlArgument);
}

std::int32_t Listener::address(std::int32_t vehicle_id) const {
  return vehicle_id == kBroadcastId ? broadcast : addresses.address_of(vehicle_id).value_or(vehicle_id);
}

void add_statistics(const Listener& listener, const modem_receive_t& packet,
                    std::vector<std::string>& lines) {
  if (!listener.reports_statistics) return;
  ReceptionReport report = report_of(packet);
  report.source = listener.address(packet.source_id);
  report.destination = listener.address(packet.destination_id);
  report.type = type_of(packet.packet_kind, packet.rate_number, is_flexible(packet));
  if (report.num_bad > 0 && packet.rate_number != 0) report.psk_error = 3;
  lines.push_back(cacst(listener.state, report));
}

std::vector<std::string> lines_of(const Listener& listener, const modem_receive_t& packet) {
  std::vector<std::string> lines;
  if (packet.packet_kind == modem_receive_t::PING) add_ping(listener, packet, lines);
  if (packet.packet_kind == modem_receive_t::MINI_PACKET) add_mini(listener, packet, lines);
  if (packet.packet_kind == modem_receive_t::DATA) {
    if (is_flexible(packet))
      add_flexible(listener, packet, lines);
    else
      add_data(listener, packet, lines);
  }
  add_statistics(listener, packet, lines);
  return lines;
}

std::vector<std::string> lines_of_ack(const Listener& listener, const modem_receive_t& ack) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < 8 * ack.payload.size(); ++i) {
    if ((ack.payload[i / 8] >> i % 8 & 1) == 0) continue;
    lines.push_back(fmt::format("CAACK,{},{},{},1", listener.address(ack.source_id),
                                listener.address(ack.destination_id), i + 1));
  }
  add_statistics(listener, ack, lines);
  return lines;
}

// The line is CACDR,time,0,src,dest,rate of the mini-frame,mask of mini-frames,mask of data frames,six
// reserved.
std::vector<std::string> lines_of_framed_ack(const Listener& listener, const modem_receive_t& ack,
                                             bool has_mini) {
  unsigned good = 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(4, ack.payload.size()); ++i)
    good |= static_cast<unsigned>(ack.payload[i]) << 8 * i;
  std::vector<std::string> lines{fmt::format("CACDR,{},0,{},{},{},{:X},{:X},0,0,0,0,0,0",
                                             arrival_of(listener, ack), listener.address(ack.source_id),
                                             listener.address(ack.destination_id), ack.rate_number,
                                             has_mini ? good & 1 : 0, has_mini ? good >> 1 : good)};
  add_statistics(listener, ack, lines);
  return lines;
}

std::string ping_answer(const Listener& listener, const modem_receive_t& answer, double one_way_s) {
  return fmt::format("CACMR,PNR,{},{},{},{:.6f},{:.1f},{:.2f},{},0,", arrival_of(listener, answer),
                     listener.address(answer.source_id), listener.address(answer.destination_id), one_way_s,
                     answer.snr_db, answer.snr_out_db, listener.state.level);
}

std::vector<std::string> lines_of(const Listener& listener, const packet_outcome_t& loss, SimTime arrival) {
  std::vector<std::string> lines;
  ReceptionReport report = report_of(loss, arrival);
  report.source = listener.address(loss.source_id);
  report.destination = listener.address(loss.destination_id);
  report.type = type_of(loss.packet_kind, loss.rate_number, false);
  const bool broke_off = report.mode == ReceptionReport::Mode::kTimeOut;
  if (broke_off) lines.push_back(fmt::format("CAMSG,PACKET_TIMEOUT,{}", loss.num_frames));
  const bool has_frames = loss.packet_kind == modem_receive_t::DATA;
  for (int i = 1; has_frames && !broke_off && i <= loss.num_frames; ++i)
    lines.push_back(fmt::format("CAMSG,BAD_CRC,{}", i));
  if (loss.rate_number != 0) report.psk_error = broke_off ? 5 : 3;
  if (listener.reports_statistics) lines.push_back(cacst(listener.state, report));
  return lines;
}

}  // namespace halocline::modem_gateway
