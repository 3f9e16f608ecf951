// SPDX-License-Identifier: BSD-3-Clause
// Nanomodem v3 (Newcastle University; sold as Delphis Succorfish): ASCII commands framed by length, without
// line ends.
//
//   host           modem
//   $?             #A007V52428        address, supply voltage (units of 15 V / 65536)
//   $A007          #A007              sets the address
//   $P008          $P008, then #R008T12345 (one-way time, units of 31.25 us) or #TO
//   $B05hello      $B05               broadcast
//   $U00805hello   $U00805            to one modem
//   $M00805hello   $M00805, then #R008T12345 or #TO within 4 s
//   anything else  E
//
// While the modem transmits or awaits an answer, each command that transmits is refused. The address is in
// non-volatile memory. Received data is written as #B00705hello (broadcast, with its source) or #U05hello
// (without source). A command may end in T and 14 digits, within the same piece of bytes: it is sent when the
// modem's 24 MHz counter reaches that value. With the option `timestamps` received data ends in the counter
// at its arrival, T and 10 digits.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "clients/modem/modem_client.h"
#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/modem_gateway/protocols/fields.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "clients/modem_gateway/protocols/protocols.h"
#include "core/archive.h"
#include "core/names.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {
namespace {

constexpr std::size_t kAddressDigits = 3, kLengthDigits = 2, kTimeDigits = 14;
constexpr std::int64_t kHighestAddress = 255, kMinBytes = 2, kMaxBytes = 64;
constexpr double kTick_s = 31.25e-6, kSupply_v = 12, kSupplyScale_v = 15;
const std::string kError = "E\r\n";
constexpr SimDuration kReplyWithin = SimDuration::from_milliseconds(4000);
// Duration of three ticks of the 24 MHz counter, ns.
constexpr std::int64_t kThreeTicksNs = 125;

// A complete command of a host.
struct Command {
  char letter = 0;
  std::int32_t address = 0;
  std::string data;
  std::optional<SimTime> at;
};

// Fields of a command: an address, and a length followed by that many bytes.
struct Shape {
  char letter;
  bool has_address, has_data;
};
constexpr std::array<Shape, 6> kShapes{{{'?', false, false},
                                        {'A', true, false},
                                        {'P', true, false},
                                        {'B', false, true},
                                        {'U', true, true},
                                        {'M', true, true}}};

std::int64_t counter_at(SimTime time) { return time.nanoseconds() / kThreeTicksNs * 3; }

// Splits the bytes of one host into commands.
class CommandReader {
 public:
  enum class Result { kCommand, kIncomplete, kWrong };

  void append(std::string_view bytes) { buffer_ += bytes; }

  // Takes the next command; a malformed one is skipped up to the next line end or $.
  Result take(Command& command) {
    while (!buffer_.empty() && (buffer_[0] == '\r' || buffer_[0] == '\n')) buffer_.erase(0, 1);
    if (buffer_.empty()) return Result::kIncomplete;
    used_ = 0;
    const Result result = read(command);
    if (result == Result::kCommand) buffer_.erase(0, used_);
    if (result == Result::kWrong) buffer_.erase(0, buffer_.find_first_of("\r\n$", 1));
    return result;
  }

 private:
  Result read(Command& command) {
    if (buffer_[0] != '$') return Result::kWrong;
    if (buffer_.size() < 2) return Result::kIncomplete;
    for (const Shape& shape : kShapes) {
      if (shape.letter != buffer_[1]) continue;
      command.letter = shape.letter;
      used_ = 2;
      std::int64_t address = 0;
      if (shape.has_address) {
        const Result result = read_number(kAddressDigits, 0, kHighestAddress, address);
        if (result != Result::kCommand) return result;
      }
      command.address = static_cast<std::int32_t>(address);
      const Result result = shape.has_data ? read_data(command) : Result::kCommand;
      return result == Result::kCommand ? read_time(command) : result;
    }
    return Result::kWrong;
  }

  Result read_number(std::size_t digits, std::int64_t lowest, std::int64_t highest, std::int64_t& value) {
    const std::string_view text = std::string_view(buffer_).substr(used_, digits);
    if (text.find_first_not_of("0123456789") != std::string_view::npos) return Result::kWrong;
    if (text.size() < digits) return Result::kIncomplete;
    const auto number = integer_in(text, lowest, highest);
    if (!number) return Result::kWrong;
    value = *number;
    used_ += digits;
    return Result::kCommand;
  }

  Result read_data(Command& command) {
    std::int64_t size = 0;
    const Result result = read_number(kLengthDigits, kMinBytes, kMaxBytes, size);
    if (result != Result::kCommand) return result;
    const auto bytes = static_cast<std::size_t>(size);
    if (buffer_.size() < used_ + bytes) return Result::kIncomplete;
    command.data = buffer_.substr(used_, bytes);
    used_ += bytes;
    return Result::kCommand;
  }

  Result read_time(Command& command) {
    if (used_ >= buffer_.size() || buffer_[used_] != 'T') return Result::kCommand;
    ++used_;
    std::int64_t counter = 0;
    const Result result = read_number(kTimeDigits, 0, INT64_MAX, counter);
    if (result == Result::kCommand) command.at = SimTime::from_nanoseconds(counter / 3 * kThreeTicksNs);
    return result;
  }

  std::string buffer_;  // between calls shorter than the longest command
  std::size_t used_ = 0;
};

class Nm3 : public Protocol {
 public:
  explicit Nm3(ProtocolContext context)
      : port_(context.port), addresses_(context.addresses), vehicle_id_(context.vehicle_id) {
    has_timestamps_ = context.options.take_flag("timestamps", false);
    context.options.require_all_taken();
  }

  void on_bytes(ClientId client, std::string_view bytes) override {
    CommandReader& reader = readers_[client];
    reader.append(bytes);
    for (;;) {
      Command command;
      const auto result = reader.take(command);
      if (result == CommandReader::Result::kIncomplete) return;
      if (command.at) command.at = port_.instant_of(*command.at);
      const bool is_too_far = command.at && *command.at > port_.now() + kMaxAhead;
      if (result == CommandReader::Result::kWrong || is_too_far) {
        port_.write(client, kError);
      } else {
        obey(client, command);
      }
    }
  }
  void on_closed(ClientId client) override { readers_.erase(client); }

  // A ping or message that could not be sent is reported as one without an answer.
  void on_receipt(const modem_receipt_t& receipt) override {
    if (is_accepted(receipt)) {
      if (waiting_ && receipt.packet_sequence == waiting_->sequence)
        waiting_->until = SimTime::from_utime(receipt.start_utime) + kReplyWithin;
      return;
    }
    port_.note("send-refused", "result=" + std::to_string(receipt.receipt_result));
    if (waiting_ && receipt.packet_sequence == waiting_->sequence) return report_no_answer();
    port_.write(kAllClients, kError);
  }

  void on_packet(const modem_receive_t& packet) override {
    switch (packet.packet_kind) {
      case modem_receive_t::PING_REPLY:
      case modem_receive_t::ACK:
        if (waiting_ && port_.is_own(packet.send_session) && packet.packet_sequence == waiting_->sequence)
          return report_range(packet);
        return;
      case modem_receive_t::DATA:
        return report_data(packet);
      default:
        return;
    }
  }

  SimTime next() const override { return waiting_ ? waiting_->until : SimTime::never(); }
  void step() override {
    if (waiting_ && port_.now() >= waiting_->until) report_no_answer();
  }

  void archive(Archive& a) override {
    std::int32_t address = own_address();
    a(address);
    if (a.is_loading()) addresses_.assign(vehicle_id_, address);
  }

 private:
  // A ping or a packet with acknowledgement whose answer has not arrived.
  struct Waiting {
    std::int64_t sequence = 0;
    std::int32_t address = 0;
    SimTime until;
  };

  std::int32_t own_address() const { return addresses_.address_of(vehicle_id_).value_or(0); }

  void obey(ClientId client, const Command& command) {
    if (command.letter == '?')
      return port_.write(client, fmt::format("#A{:03}V{:05}\r\n", own_address(),
                                             std::llround(kSupply_v / kSupplyScale_v * 65536)));
    if (command.letter == 'A') {
      addresses_.assign(vehicle_id_, command.address);
      note_stored();
      return port_.write(client, fmt::format("#A{:03}\r\n", command.address));
    }
    port_.write(client, send(command) ? echo_of(command) : kError);
  }

  static std::string echo_of(const Command& command) {
    switch (command.letter) {
      case 'P':
        return fmt::format("$P{:03}\r\n", command.address);
      case 'B':
        return fmt::format("$B{:02}\r\n", command.data.size());
      default:
        return fmt::format("${}{:03}{:02}\r\n", command.letter, command.address, command.data.size());
    }
  }

  // Returns true when the packet was accepted for transmission.
  bool send(const Command& command) {
    const std::int32_t destination =
        command.letter == 'B' ? kBroadcastId : addresses_.vehicle_of(command.address);
    const bool wants_answer = command.letter == 'P' || command.letter == 'M';
    const bool is_to_other = destination != vehicle_id_ && destination != kBroadcastId;
    if (waiting_ || port_.unsent() > 0 || (wants_answer && !is_to_other)) return false;
    const clients::SendOptions options = command.letter == 'P'
                                             ? clients::SendOptions{.kind = modem_send_t::PING}
                                             : clients::SendOptions{.wants_ack = wants_answer};
    const auto sequence =
        port_.send(command.at.value_or(port_.now()), destination, as_bytes(command.data), options);
    if (sequence != kNotSent && wants_answer) {
      const SimTime start = std::max(port_.now(), command.at.value_or(SimTime()));
      waiting_ = {sequence, command.address, start + kReplyWithin};
    }
    return sequence != kNotSent;
  }

  void report_no_answer() {
    waiting_.reset();
    port_.write(kAllClients, "#TO\r\n");
  }

  void report_range(const modem_receive_t& packet) {
    const auto ticks = std::llround(packet.two_way_travel_time_s / 2 / kTick_s);
    port_.write(kAllClients, fmt::format("#R{:03}T{:05}\r\n", waiting_->address, ticks));
    waiting_.reset();
  }

  void report_data(const modem_receive_t& packet) {
    if (packet.destination_id != kBroadcastId && packet.destination_id != vehicle_id_) return;
    std::string line = packet.destination_id == kBroadcastId
                           ? fmt::format("#B{:03}", addresses_.address_of(packet.source_id).value_or(0))
                           : std::string("#U");
    line += fmt::format("{:02}", packet.payload.size());
    line += as_text(packet.payload);
    constexpr std::int64_t kTenDigits = 10'000'000'000;
    if (has_timestamps_)
      line += fmt::format("T{:010}", counter_at(SimTime::from_utime(packet.arrival_utime)) % kTenDigits);
    port_.write(kAllClients, line + "\r\n");
  }

  ProtocolPort& port_;
  AddressBook& addresses_;
  std::int32_t vehicle_id_;
  bool has_timestamps_;
  std::map<ClientId, CommandReader> readers_;
  std::optional<Waiting> waiting_;
};

}  // namespace

std::unique_ptr<Protocol> make_nm3(ProtocolContext context) {
  return std::make_unique<Nm3>(std::move(context));
}

}  // namespace halocline::modem_gateway
