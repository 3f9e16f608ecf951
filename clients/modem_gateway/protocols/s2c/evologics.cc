// SPDX-License-Identifier: BSD-3-Clause
// EvoLogics S2C modem: AT commands in command mode, which is that of a network interface, and in data mode
// (`+++AT`); instant, synchronous and piggy-back messages, bursts, and positions of a USBL head.
//
// Each host has its own mode, which ATO and ATC change. In data mode, bytes other than commands go to the
// remote address (!AR) as bursts of up to 1024 bytes, once 50 ms have passed without further bytes. Bytes
// received from another modem's stream are written unchanged to hosts in data mode, and as RECV to the
// others. Option: `mode` (net or data: the mode of a host when it connects, which ?MODE reports as NET or
// AT).
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "clients/modem/modem_client.h"
#include "clients/modem_gateway/protocols/fields.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "clients/modem_gateway/protocols/protocols.h"
#include "clients/modem_gateway/protocols/s2c/s2c_core.h"
#include "clients/modem_gateway/protocols/s2c/s2c_messages.h"
#include "clients/modem_gateway/protocols/s2c/s2c_reader.h"
#include "clients/modem_gateway/protocols/s2c/s2c_sender.h"
#include "clients/modem_gateway/protocols/s2c/s2c_settings.h"
#include "core/archive.h"
#include "core/check.h"
#include "core/elementary.h"
#include "core/names.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {
namespace {

constexpr SimDuration kStreamPause = SimDuration::from_milliseconds(50);
constexpr std::size_t kMaxStreamBurst = 1024, kMaxStream = 16 * kMaxStreamBurst;
// Most packets that are remembered because their bearing may still arrive.
constexpr std::size_t kMaxRecent = 32;
// The table of ?P has at least this many lines, padded with zeros, because hosts read that many.
constexpr std::size_t kMinPaths = 8;
// Time-out of ?P: when the channel server has not replied by then, the table is empty.
constexpr SimDuration kPathsWithin = SimDuration::from_milliseconds(800);

// A message with the same number within this time counts as a repetition. It is longer than all attempts of
// one message take, and shorter than seven failing messages take, after which numbers recur.
constexpr SimDuration kRepeatedWithin = SimDuration::from_milliseconds(30'000);

class Evologics : public Protocol {
 public:
  explicit Evologics(ProtocolContext context)
      : core_(context, [this](const std::string& body) { tell_all(body); }),
        port_(context.port),
        sender_(core_),
        settings_(core_, sender_, [this] { note_stored(); }) {
    const std::string mode = context.options.take("mode", "net");
    require(mode == "net" || mode == "data", "option mode is '" + mode + "'; allowed are net and data");
    begins_in_data_mode_ = mode == "data";
    context.options.require_all_taken();
  }

  std::optional<clients::ListenOptions> listening() const override {
    return clients::ListenOptions{.wakes = {}, .promiscuous = true, .events = true};
  }

  void on_opened(ClientId client) override { hosts_[client].set_data_mode(begins_in_data_mode_); }
  void on_closed(ClientId client) override { hosts_.erase(client); }
  void on_bytes(ClientId client, std::string_view bytes) override {
    S2cReader& reader = hosts_[client];
    reader.append(bytes);
    while (auto item = reader.take()) {
      if (item->command)
        obey(client, *item->command);
      else
        take_stream(item->data);
    }
    if (reader.is_data_mode()) stream_due_ = port_.now() + kStreamPause;
  }

  void on_receipt(const modem_receipt_t& receipt) override { sender_.on_receipt(receipt); }
  void on_event(const modem_event_t& event) override {
    sender_.on_event(event);
    if (event.modem_event == modem_event_t::PACKET_DETECTED) core_.tell_more("RECVSTART");
  }
  void on_loss(const packet_outcome_t& loss) override { core_.tell_more(receive_failed(core_, loss)); }

  void on_packet(const modem_receive_t& packet) override {
    if (!clients::is_whole(packet)) return;
    core_.tell_more(receive_end(core_, packet));
    last_source_ = packet.source_id;
    const bool is_answer = port_.is_own(packet.send_session) && packet.destination_id == core_.vehicle_id();
    if (is_answer && packet.packet_kind == modem_receive_t::ACK) {
      remember(packet, true, packet.two_way_travel_time_s / 2);
      return sender_.on_ack(packet);
    }
    if (packet.packet_kind != modem_receive_t::DATA) return;
    const bool is_for_us =
        packet.destination_id == core_.vehicle_id() || packet.destination_id == kBroadcastId;
    if (!is_for_us && core_.setting("!RP") == 0) return;
    if (!is_repetition(packet)) report(packet);
    if (is_for_us && packet.wants_ack) sender_.on_acknowledged(packet);
  }

  void on_bearing(const vehicle_usbl_t& bearing) override {
    const auto found = std::find_if(recent_.begin(), recent_.end(), [&](const Recent& recent) {
      return recent.session == bearing.send_session && recent.sequence == bearing.packet_sequence &&
             recent.kind == bearing.packet_kind;
    });
    if (found == recent_.end()) return;
    S2cFix fix = found->fix;
    recent_.erase(found);
    fix.bearing_rad = bearing.peer_bearing_rad;
    fix.elevation_rad = bearing.peer_elevation_rad;
    fix.deviation_rad = bearing.angle_deviation_rad;
    fix.measured = port_.clock_at(SimTime::from_utime(bearing.utime));
    const S2cPosition position = position_message(core_, fix);
    if (!position.position.empty()) settings_.note_position(position.position);
    if (core_.setting("@ZU") != 0) core_.tell(position.message);
  }

  void on_paths(const link_reply_t& reply) override {
    if (!paths_client_) return;
    double strongest_db = -HUGE_VAL;
    const auto& paths = reply.link_paths.paths;
    for (const arrival_t& path : paths) strongest_db = std::max(strongest_db, path.path_level_db);
    std::vector<ShownPath> shown;
    for (const arrival_t& path : paths)
      shown.push_back({std::llround(1e6 * (path.path_delay_s - paths.front().path_delay_s)),
                       std::lround(1000 * elementary::exp10((path.path_level_db - strongest_db) / 20))});
    answer_paths(std::move(shown));
  }

  void archive(Archive& a) override { core_.archive(a); }

  SimTime next() const override { return std::min({sender_.next(), stream_due_, paths_due_}); }
  void step() override {
    sender_.step();
    if (port_.now() >= paths_due_) answer_paths({});
    if (port_.now() >= stream_due_) send_stream();
  }

 private:
  struct ShownPath {
    long long delay_us = 0;
    long amplitude = 0;  // relative to the strongest path, which has 1000
  };
  // A packet whose bearing may still arrive.
  struct Recent {
    std::int64_t session, sequence;
    std::int8_t kind;
    S2cFix fix;
  };

  void answer(ClientId client, const std::string& name, const std::string& body) {
    const auto host = hosts_.find(client);
    if (host == hosts_.end()) return;
    port_.write(client, host->second.is_data_mode()
                            ? fmt::format("+++AT{}:{}:{}\r\n", name, body.size(), body)
                            : body + "\r\n");
  }
  void tell_all(const std::string& body) {
    for (const auto& [client, host] : hosts_)
      port_.write(client,
                  host.is_data_mode() ? fmt::format("+++AT:{}:{}\r\n", body.size(), body) : body + "\r\n");
  }

  void obey(ClientId client, const S2cCommand& command) {
    const std::string& name = command.name;
    if (!command.is_well_formed) return answer(client, name, "ERROR WRONG FORMAT");
    if (!command.fields.empty()) return answer(client, name, sender_.take(command));
    if (name == "O" || name == "C") return change_mode(client, name == "O");
    if (name == "?P") return ask_paths(client);
    if (name == "?MODE") return answer(client, name, begins_in_data_mode_ ? "AT" : "NET");
    answer(client, name, settings_.answer(command).value_or("ERROR UNKNOWN COMMAND"));
  }

  void change_mode(ClientId client, bool to_data) {
    answer(client, to_data ? "O" : "C", "OK");
    if (const auto host = hosts_.find(client); host != hosts_.end()) host->second.set_data_mode(to_data);
  }

  // Answers ?P with the sound paths from the modem that was heard last.
  void ask_paths(ClientId client) {
    const bool is_asked = !paths_client_ && last_source_ != kBroadcastId && port_.ask_paths(last_source_);
    if (!is_asked) return answer(client, "?P", paths_text({}));
    paths_client_ = client;
    paths_due_ = port_.now() + kPathsWithin;
  }
  void answer_paths(std::vector<ShownPath> paths) {
    paths_due_ = SimTime::never();
    answer(*std::exchange(paths_client_, std::nullopt), "?P", paths_text(std::move(paths)));
  }
  static std::string paths_text(std::vector<ShownPath> paths) {
    paths.resize(std::max(paths.size(), kMinPaths));
    std::string text;
    for (const auto& [delay_us, amplitude] : paths) text += fmt::format("{} {}\n", delay_us, amplitude);
    return text;
  }

  // Returns true for a message that is sent again because its acknowledgement was lost.
  bool is_repetition(const modem_receive_t& packet) {
    const int number = s2c_payload(packet).number;
    if (number == 0) return false;
    auto& [last, since] = numbers_[{packet.source_id, packet.destination_id, packet.rate_number}];
    const bool is_same = last == number && port_.now() < since + kRepeatedWithin;
    last = number;
    since = port_.now();
    return is_same;
  }

  void report(const modem_receive_t& packet) {
    const S2cPayload payload = s2c_payload(packet);
    const bool is_burst = packet.rate_number == kS2cBurstRate;
    const bool is_synchronous = !is_burst && payload.kind == S2cKind::kSynchronous;
    remember(packet, packet.wants_ack || is_synchronous, packet.travel_time_s);
    if (!is_burst || payload.kind != kS2cStream) return core_.tell(received_message(core_, packet));
    const std::string message = received_message(core_, packet) + "\r\n";
    for (const auto& [client, host] : hosts_)
      port_.write(client, host.is_data_mode() ? as_text(payload.bytes) : std::string_view(message));
  }

  void remember(const modem_receive_t& packet, bool has_range, double travel_time_s) {
    const S2cQuality q = quality_of(core_, packet);
    S2cFix fix;
    fix.address = core_.address_of(packet.source_id);
    fix.has_range = has_range && travel_time_s > 0;
    fix.travel_time_s = travel_time_s;
    fix.rssi = q.rssi;
    fix.integrity = q.integrity;
    recent_.push_back({packet.send_session, packet.packet_sequence, packet.packet_kind, fix});
    if (recent_.size() > kMaxRecent) recent_.pop_front();
  }

  void take_stream(std::string_view data) {
    if (core_.setting("!AR") == 0 || stream_.size() + data.size() > kMaxStream) {
      dropped_ += data.size();
      return core_.tell(fmt::format("DROPCNT,{}", dropped_));
    }
    stream_ += data;
  }
  void send_stream() {
    stream_due_ = SimTime::never();
    for (auto& [client, host] : hosts_) {
      if (const std::string held = host.take_held(); !held.empty()) take_stream(held);
    }
    for (; !stream_.empty(); stream_.erase(0, kMaxStreamBurst)) {
      S2cMessage burst{S2cMessage::Type::kBurst,
                       static_cast<std::int32_t>(core_.setting("!AR")),
                       {kS2cStream, 0, as_bytes(stream_.substr(0, kMaxStreamBurst))},
                       true,
                       {}};
      if (sender_.take(std::move(burst)) == "OK") continue;
      stream_due_ = port_.now() + kStreamPause;  // the queue is full
      return;
    }
  }

  S2cCore core_;
  ProtocolPort& port_;
  S2cSender sender_;
  // Last message number of each (source, destination, rate), and when it was received.
  std::map<std::tuple<std::int32_t, std::int32_t, std::int32_t>, std::pair<int, SimTime>> numbers_;
  S2cSettings settings_;
  bool begins_in_data_mode_ = false;
  std::map<ClientId, S2cReader> hosts_;
  std::deque<Recent> recent_;
  std::int32_t last_source_ = kBroadcastId;
  std::optional<ClientId> paths_client_;
  SimTime paths_due_ = SimTime::never(), stream_due_ = SimTime::never();
  std::string stream_;
  std::size_t dropped_ = 0;
};

}  // namespace

std::unique_ptr<Protocol> make_evologics(ProtocolContext context) {
  return std::make_unique<Evologics>(std::move(context));
}

}  // namespace halocline::modem_gateway
