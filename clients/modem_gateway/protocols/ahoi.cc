// SPDX-License-Identifier: BSD-3-Clause
// ahoi modem (Hamburg University of Technology): binary frames on a serial line.
//
//    10 02 content 10 03, a byte 10 of the content doubled
//    content: source, destination, type, status, sequence number, length, payload;
//             frames that were received through the water end with a footer of 6 bytes:
//             power, rssi, bit errors, gain mean, gain minimum, gain maximum
//
// - Types: 0 to 7E are data, 7F acknowledgements, 80 to FD commands.
// - Answers: the modem answers each frame of the host at once. FF confirms it. FE refuses a malformed frame,
//   an unknown command, more than 126 bytes of data (type and sequence number travel with the data), and data
//   while one packet already waits behind the one being transmitted. FE also follows later when a confirmed
//   packet cannot be sent.
// - Status: bits, which the receiver's host sees as they were sent. 1 asks for an acknowledgement, 2 for one
//   with the two-way travel time (us, four bytes, high byte first).
// - Commands: 84 reads or sets the modem's address, 85 reads the battery (mV, two bytes), 87 resets.
//   Parameters of the other commands are only stored and returned. Address and gains are in non-volatile
//   memory.
// - Footer: power is the received level in dB re 1 uPa, rssi the SNR in dB + 128, gain 170 dB less the level.
//
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
#include "core/archive.h"
#include "core/names.h"

namespace halocline::modem_gateway {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t kEscape = 0x10, kBegin = 0x02, kEnd = 0x03, kAll = 0xff;
constexpr std::uint8_t kAcknowledgement = 0x7f, kId = 0x84, kBattery = 0x85, kReset = 0x87;
constexpr std::uint8_t kRefusal = 0xfe, kConfirmation = 0xff;
constexpr std::uint8_t kWantsAck = 1, kWantsRange = 2;
constexpr std::size_t kHeaderBytes = 6, kMaxPayload = 128, kWithData = 2, kMaxAsked = 64;
// Most packets accepted at a time: one being transmitted and one behind it.
constexpr std::size_t kMaxSending = 2;
// Commands that switch gain control and set the gains of two stages, the transmitter and the receiver.
constexpr std::array<std::uint8_t, 4> kGains{0x98, 0x99, 0x9a, 0x9e};
// Ranges of the other commands that the public host programs send, besides id, battery and reset.
constexpr std::array<std::pair<std::uint8_t, std::uint8_t>, 6> kKnown{
    {{0x80, 0x83}, {0x88, 0x9e}, {0xa0, 0xa1}, {0xa8, 0xa9}, {0xb1, 0xb9}, {0xc0, 0xc7}}};

bool is_command(std::uint8_t type) {
  if (type == kId || type == kBattery || type == kReset) return true;
  return std::any_of(kKnown.begin(), kKnown.end(),
                     [&](const auto& range) { return type >= range.first && type <= range.second; });
}
constexpr double kFull_mv = 12'000, kEmpty_mv = 9'600, kReference_db = 170;

struct AhoiFrame {
  std::uint8_t source = 0, destination = 0, type = 0, status = 0, number = 0;
  Bytes payload;
  bool is_malformed = false;  // too long, or its length field is wrong
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

// Decoder of the frames in a host's byte stream; bytes outside of frames are skipped, and so is a frame
// without a complete header.
class FrameReader {
 public:
  // Returns the frame that this byte completes, if any.
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
    if (content_ && content_->size() <= kHeaderBytes + kMaxPayload) content_->push_back(byte);
    return std::nullopt;
  }

 private:
  std::optional<AhoiFrame> finish() {
    const auto content = std::exchange(content_, std::nullopt);
    if (!content || content->size() < kHeaderBytes) return std::nullopt;
    const bool is_whole =
        content->size() == kHeaderBytes + (*content)[5] && content->size() <= kHeaderBytes + kMaxPayload;
    return AhoiFrame{(*content)[0], (*content)[1], (*content)[2],
                     (*content)[3], (*content)[4], {content->begin() + kHeaderBytes, content->end()},
                     !is_whole};
  }

  std::optional<Bytes> content_;  // frame that has begun, at most one byte longer than the longest
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

  void on_receipt(const modem_receipt_t& receipt) override {
    const auto asked = asked_.find(receipt.packet_sequence);
    if (asked == asked_.end()) return;
    if (!is_accepted(receipt)) {
      port_.note("send-refused", "result=" + std::to_string(receipt.receipt_result));
      answer(kAllClients, kRefusal, asked->second.number);
    }
    if (!is_accepted(receipt) || !wants_ack(asked->second.status)) asked_.erase(asked);
  }

  void on_packet(const modem_receive_t& packet) override {
    if (packet.packet_kind == modem_receive_t::ACK && port_.is_own(packet.send_session))
      return report_ack(packet);
    const bool is_for_us = packet.destination_id == vehicle_id_ || packet.destination_id == kBroadcastId;
    if (packet.packet_kind != modem_receive_t::DATA || !is_for_us || packet.payload.size() < kWithData)
      return;
    const auto status = static_cast<std::uint8_t>(packet.header_number);
    const AhoiFrame frame{address_of(packet.source_id),
                          address_of(packet.destination_id),
                          packet.payload[0],
                          status,
                          packet.payload[1],
                          {packet.payload.begin() + kWithData, packet.payload.end()}};
    port_.write(kAllClients, encoded(frame, footer_of(packet)));
  }

  void archive(Archive& a) override {
    std::uint8_t address = address_of(vehicle_id_);
    a(address, gains_);
    if (a.is_loading()) addresses_.assign(vehicle_id_, address);
  }

 private:
  // A sent frame whose receipt or acknowledgement may still come.
  struct Asked {
    std::uint8_t number, status;
  };

  std::uint8_t address_of(std::int32_t vehicle_id) const {
    return vehicle_id == kBroadcastId
               ? kAll
               : static_cast<std::uint8_t>(addresses_.address_of(vehicle_id).value_or(0));
  }

  static bool wants_ack(std::uint8_t status) { return (status & (kWantsAck | kWantsRange)) != 0; }

  void answer(ClientId client, std::uint8_t type, std::uint8_t number, Bytes payload = {}) {
    port_.write(client, encoded({address_of(vehicle_id_), kAll, type, 0, number, std::move(payload)}));
  }

  void obey(ClientId client, const AhoiFrame& frame) {
    if (frame.type >= kRefusal) return;
    const bool is_data = frame.type < kAcknowledgement;
    const bool is_taken = !frame.is_malformed && (is_data ? send(frame) : is_command(frame.type));
    answer(client, is_taken ? kConfirmation : kRefusal, frame.number);
    if (!is_taken || is_data) return;
    Bytes value = answer_to(frame);  // may set the address that answer() then sends
    answer(client, frame.type, frame.number, std::move(value));
  }

  // Returns true when the packet was accepted for transmission.
  bool send(const AhoiFrame& frame) {
    if (frame.payload.size() > kMaxPayload - kWithData || port_.unsent() >= kMaxSending) return false;
    const std::int32_t to =
        frame.destination == kAll ? kBroadcastId : addresses_.vehicle_of(frame.destination);
    Bytes packet{frame.type, frame.number};
    packet.insert(packet.end(), frame.payload.begin(), frame.payload.end());
    const auto sequence = port_.send(
        port_.now(), to, packet,
        {.wants_ack = wants_ack(frame.status) && to != kBroadcastId, .header_number = frame.status});
    if (sequence == kNotSent) return false;
    asked_[sequence] = {frame.number, frame.status};
    if (asked_.size() > kMaxAsked) asked_.erase(asked_.begin());
    return true;
  }

  Bytes answer_to(const AhoiFrame& command) {
    if (command.type == kId) return set_address(command.payload);
    if (command.type == kBattery) {
      const auto mv = static_cast<std::uint32_t>(battery_mv());
      return {static_cast<std::uint8_t>(mv >> 8), static_cast<std::uint8_t>(mv & 255)};
    }
    if (command.type == kReset) {
      parameters_.clear();
      return {};
    }
    const bool is_gain = std::find(kGains.begin(), kGains.end(), command.type) != kGains.end();
    auto& parameters = is_gain ? gains_ : parameters_;
    if (!command.payload.empty()) {
      parameters[command.type] = command.payload;
      if (is_gain) note_stored();
    }
    return parameters[command.type];
  }

  Bytes set_address(const Bytes& wanted) {
    if (!wanted.empty() && wanted[0] != kAll) {
      addresses_.assign(vehicle_id_, wanted[0]);
      note_stored();
    }
    return {address_of(vehicle_id_)};
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
    if ((asked->second.status & kWantsRange) != 0) {
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
  std::map<std::int64_t, Asked> asked_;               // key: packet_sequence
  std::map<std::uint8_t, Bytes> gains_, parameters_;  // key: command; gains are non-volatile
};

}  // namespace

std::unique_ptr<Protocol> make_ahoi(ProtocolContext context) {
  return std::make_unique<Ahoi>(std::move(context));
}

}  // namespace halocline::modem_gateway
