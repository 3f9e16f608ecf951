// SPDX-License-Identifier: BSD-3-Clause
// ahoi modem (Hamburg University of Technology): binary frames on a serial line.
//
//   10 02 content 10 03, a byte 10 of the content doubled
//   content: source, destination, type, status, sequence number, length, payload; of what was received a footer of 6: power, rssi, bit
//   errors, gain mean, least, greatest
//
// Types 0 to 7E are data, 7F acknowledgements, 80 to FE commands, FF confirmations: each frame of the host is confirmed at once. Status 1
// asks the receiver for an acknowledgement, 2 for one with the two-way time (us, four bytes, high byte first). Type and sequence number go
// with the data, so a frame holds up to 126 bytes. Commands: 84 the modem's address, 85 the battery (mV, two bytes); of all others the
// parameters are kept and returned. Footer: power is the level in dB re 1 uPa, rssi the SNR in dB + 128, gain 170 dB less the level.
// Options: none.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "clients/modem/modem_client.h"
#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/modem_gateway/protocols/fields.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "clients/modem_gateway/protocols/protocols.h"
#include "core/names.h"

namespace halocline::modem_gateway {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t kEscape = 0x10, kBegin = 0x02, kEnd = 0x03, kAll = 0xff;
constexpr std::uint8_t kAcknowledgement = 0x7f, kId = 0x84, kBattery = 0x85, kConfirmation = 0xff;
constexpr std::uint8_t kWantsAck = 1, kWantsRange = 2;
constexpr std::size_t kHeaderBytes = 6, kMaxPayload = 128, kWithData = 2, kMaxAsked = 64;
constexpr double kFull_mv = 12'000, kEmpty_mv = 9'600, kReference_db = 170;

struct AhoiFrame {
  std::uint8_t source = 0, destination = 0, type = 0, status = 0, number = 0;
  Bytes payload;
};

std::string encoded(const AhoiFrame& frame, std::span<const std::uint8_t> footer = {}) {
  Bytes content{frame.source, frame.destination, frame.type,
                frame.status, frame.number,      static_cast<std::uint8_t>(frame.payload.size())};
  content.insert(content.end(), frame.payload.begin(), frame.payload.end());
  content.insert(content.end(), footer.begin(), footer.end());
  std::string bytes{static_cast<char>(kEscape), static_cast<char>(kBegin)};
  for (const std::uint8_t byte : content) {
    if (byte == kEscape) bytes += static_cast<char>(kEscape);
    bytes += static_cast<char>(byte);
  }
  return bytes + static_cast<char>(kEscape) + static_cast<char>(kEnd);
}

// Frames out of the bytes of a host; what is none is skipped.
class FrameReader {
 public:
  // The frame that this byte completes.
  std::optional<AhoiFrame> take(std::uint8_t byte) {
    const bool was_escaped = std::exchange(is_escaped_, false);
    if (!was_escaped && byte == kEscape) {
      is_escaped_ = true;
      return std::nullopt;
    }
    if (was_escaped && byte == kBegin) {
      content_.emplace();
      return std::nullopt;
    }
    if (was_escaped && byte == kEnd) return finish();
    if (was_escaped && byte != kEscape) content_.reset();
    if (content_ && content_->size() < kHeaderBytes + kMaxPayload)
      content_->push_back(byte);
    else
      content_.reset();
    return std::nullopt;
  }

 private:
  std::optional<AhoiFrame> finish() {
    const auto content = std::exchange(content_, std::nullopt);
    if (!content || content->size() < kHeaderBytes || content->size() != kHeaderBytes + (*content)[5])
      return std::nullopt;
    return AhoiFrame{(*content)[0], (*content)[1], (*content)[2],
                     (*content)[3], (*content)[4], {content->begin() + kHeaderBytes, content->end()}};
  }

  std::optional<Bytes> content_;  // of the frame that has begun
  bool is_escaped_ = false;
};

std::uint8_t as_byte(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

std::array<std::uint8_t, 6> footer_of(const modem_receive_t& packet) {
  const std::uint8_t gain = as_byte(kReference_db - packet.received_level_db);
  return {as_byte(packet.received_level_db), as_byte(packet.snr_db + 128), 0, gain, gain, gain};
}

class Ahoi : public Protocol {
 public:
  explicit Ahoi(ProtocolContext context)
      : port_(context.port), addresses_(context.addresses), vehicle_id_(context.vehicle_id) {
    context.options.require_all_taken();
  }

  void on_bytes(ClientId client, std::string_view bytes) override {
    FrameReader& reader = readers_[client];
    for (const char byte : bytes) {
      if (const auto frame = reader.take(static_cast<std::uint8_t>(byte))) obey(client, *frame);
    }
  }
  void on_closed(ClientId client) override { readers_.erase(client); }

  void on_packet(const modem_receive_t& packet) override {
    if (packet.packet_kind == modem_receive_t::ACK && port_.is_own(packet.send_session))
      return report_ack(packet);
    const bool is_for_us = packet.destination_id == vehicle_id_ || packet.destination_id == kBroadcastId;
    if (packet.packet_kind != modem_receive_t::DATA || !is_for_us || packet.payload.size() < kWithData)
      return;
    const std::uint8_t status = packet.wants_ack ? kWantsAck : 0;
    const AhoiFrame frame{address_of(packet.source_id),
                          address_of(packet.destination_id),
                          packet.payload[0],
                          status,
                          packet.payload[1],
                          {packet.payload.begin() + kWithData, packet.payload.end()}};
    port_.write(kAllClients, encoded(frame, footer_of(packet)));
  }

 private:
  // A frame whose acknowledgement may come.
  struct Asked {
    std::uint8_t number, status;
  };

  std::uint8_t address_of(std::int32_t vehicle_id) const {
    return vehicle_id == kBroadcastId
               ? kAll
               : static_cast<std::uint8_t>(addresses_.address_of(vehicle_id).value_or(0));
  }

  void obey(ClientId client, const AhoiFrame& frame) {
    if (frame.type == kConfirmation) return;
    port_.write(client, encoded({address_of(vehicle_id_), kAll, kConfirmation, 0, frame.number, {}}));
    if (frame.type < kAcknowledgement) return send(frame);
    if (frame.type == kAcknowledgement) return;
    AhoiFrame answer{0, kAll, frame.type, 0, frame.number, answer_to(frame)};
    answer.source = address_of(vehicle_id_);  // which the command may have set
    port_.write(client, encoded(answer));
  }

  void send(const AhoiFrame& frame) {
    if (frame.payload.size() > kMaxPayload - kWithData)
      return port_.note("too-large", "bytes=" + std::to_string(frame.payload.size()));
    const std::int32_t to =
        frame.destination == kAll ? kBroadcastId : addresses_.vehicle_of(frame.destination);
    Bytes packet{frame.type, frame.number};
    packet.insert(packet.end(), frame.payload.begin(), frame.payload.end());
    const bool wants_ack = (frame.status == kWantsAck || frame.status == kWantsRange) && to != kBroadcastId;
    const auto sequence = port_.send(port_.now(), to, packet, {.wants_ack = wants_ack});
    if (!wants_ack) return;
    asked_[sequence] = {frame.number, frame.status};
    if (asked_.size() > kMaxAsked) asked_.erase(asked_.begin());
  }

  Bytes answer_to(const AhoiFrame& command) {
    if (command.type == kId) {
      if (!command.payload.empty() && command.payload[0] != kAll)
        addresses_.assign(vehicle_id_, command.payload[0]);
      return {address_of(vehicle_id_)};
    }
    if (command.type == kBattery) {
      const auto mv = static_cast<std::uint32_t>(battery_mv());
      return {static_cast<std::uint8_t>(mv >> 8), static_cast<std::uint8_t>(mv & 255)};
    }
    if (!command.payload.empty()) parameters_[command.type] = command.payload;
    return parameters_[command.type];
  }

  double battery_mv() const {
    const vehicle_battery_t* battery = port_.battery();
    if (battery == nullptr || battery->capacity_j <= 0) return kFull_mv;
    const double left = std::clamp(battery->energy_left_j / battery->capacity_j, 0.0, 1.0);
    return battery->battery_empty ? 0 : kEmpty_mv + (kFull_mv - kEmpty_mv) * left;
  }

  void report_ack(const modem_receive_t& packet) {
    const auto asked = asked_.find(packet.packet_sequence);
    if (asked == asked_.end() || packet.payload.empty() || (packet.payload[0] & 1) == 0) return;
    AhoiFrame ack{
        address_of(packet.source_id), address_of(vehicle_id_), kAcknowledgement, 0, asked->second.number, {}};
    if (asked->second.status == kWantsRange) {
      const auto us = static_cast<std::uint32_t>(std::llround(packet.two_way_travel_time_s * 1e6));
      for (const int shift : {24, 16, 8, 0})
        ack.payload.push_back(static_cast<std::uint8_t>(us >> shift & 255));
    }
    asked_.erase(asked);
    port_.write(kAllClients, encoded(ack, footer_of(packet)));
  }

  ProtocolPort& port_;
  AddressBook& addresses_;
  std::int32_t vehicle_id_;
  std::map<ClientId, FrameReader> readers_;
  std::map<std::int64_t, Asked> asked_;  // by packet_sequence
  std::map<std::uint8_t, Bytes> parameters_;
};

}  // namespace

std::unique_ptr<Protocol> make_ahoi(ProtocolContext context) {
  return std::make_unique<Ahoi>(std::move(context));
}

}  // namespace halocline::modem_gateway
