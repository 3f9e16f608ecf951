// SPDX-License-Identifier: BSD-3-Clause
// WHOI Micromodem, first and second generation: NMEA sentences, CC from the host, CA and SN from the modem.
//
// Options:
// - `revision`: firmware; 0.94.0.00 is the first generation, 2.0.31000 the second, 3.0.0 its newer firmware.
// - `pps`: the modem's clock receives a pulse per second (modem_clock.h).
// - `broadcast`: the broadcast address; 15 is a second one unless a modem has been given it.
// - `lbl`: up to four transponders (micromodem_lbl.h).
// - `newer_lines`: CARFP instead of CARDP.
//
// Answers go to the host that asked, everything else to all hosts. The test sounds of CCMSQ, CCSWP and CCRSP
// are not simulated; these commands are refused.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "clients/modem/modem_client.h"
#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/modem_gateway/protocols/fields.h"
#include "clients/modem_gateway/protocols/line_reader.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_core.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_housekeeping.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_lbl.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_receptions.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_remote.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_transmitter.h"
#include "clients/modem_gateway/protocols/micromodem/nmea.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "clients/modem_gateway/protocols/protocols.h"
#include "core/archive.h"
#include "core/check.h"
#include "core/names.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {
namespace {

using Kind = MicromodemTransmitter::Kind;

class Micromodem : public Protocol {
 public:
  explicit Micromodem(ProtocolContext context)
      : core_(context, [this] { note_stored(); }),
        port_(context.port),
        housekeeping_(core_),
        lbl_(core_, context.addresses),
        transmitter_(core_),
        remote_(core_, transmitter_, housekeeping_) {
    lbl_.name_transponders(context.options.take("lbl", ""));
    context.options.require_all_taken();
  }

  std::optional<clients::ListenOptions> listening() const override {
    return clients::ListenOptions{.wakes = {}, .promiscuous = true, .events = true};
  }

  void on_bytes(ClientId client, std::string_view bytes) override {
    readers_[client].take(
        bytes, [&](std::string_view line) { take_line(client, line); },
        [&] { core_.refuse(client, NmeaError::kUnknown, "line too long"); });
  }
  void on_closed(ClientId client) override { readers_.erase(client); }

  void on_receipt(const modem_receipt_t& receipt) override {
    if (!lbl_.takes(receipt)) transmitter_.on_receipt(receipt);
  }

  void on_packet(const modem_receive_t& packet) override {
    housekeeping_.note_noise(packet.noise_level_db);
    const bool is_own = port_.is_own(packet.send_session) && packet.destination_id == core_.vehicle_id();
    if (is_own) return take_answer(packet);
    if (packet.packet_kind == modem_receive_t::PING_REPLY || packet.packet_kind == modem_receive_t::ACK)
      return;
    core_.say_all(lines_of(core_.listener(), packet));
    if (packet.packet_kind != modem_receive_t::MINI_PACKET || packet.destination_id != core_.vehicle_id())
      return;
    if (kind_of(packet) == MicromodemKind::kCycle) return follow_cycle(packet);
    remote_.follow(packet);
  }

  // Reports CARXP: 0 for frequency-shift keying, 1 for phase-shift keying.
  void on_event(const modem_event_t& event) override {
    if (event.modem_event == modem_event_t::PACKET_DETECTED && core_.settings().is_on("RXP"))
      core_.say_all(event.rate_number == 0 ? "CARXP,0" : "CARXP,1");
  }
  void on_loss(const packet_outcome_t& loss) override {
    housekeeping_.note_noise(loss.noise_level_db);
    const SimTime arrival =
        SimTime::from_utime(loss.departure_utime) + SimDuration::from_seconds(loss.travel_time_s);
    core_.say_all(lines_of(core_.listener(), loss, port_.clock_at(arrival)));
  }

  std::vector<std::int32_t> transponders() const override { return lbl_.transponders(); }

  void archive(Archive& a) override { core_.archive(a); }

  SimTime next() const override { return std::min({housekeeping_.next(), lbl_.next(), transmitter_.next()}); }
  void step() override {
    housekeeping_.step();
    lbl_.step();
    transmitter_.step();
  }

 private:
  using Command = void (Micromodem::*)(ClientId, const NmeaSentence&);
  struct Named {
    std::string_view id;
    Command command;
    bool sends;  // refused while the transmit queue is full
  };
  static constexpr std::array<Named, 8> commands() {
    return {{{"CCCYC", &Micromodem::begin_cycle, true},
             {"CCTXD", &Micromodem::take_hex, false},
             {"CCTXA", &Micromodem::take_text, false},
             {"CCMUC", &Micromodem::send_mini, true},
             {"CCMPC", &Micromodem::ping, true},
             {"CCCMD", &Micromodem::command, true},
             {"CCTDP", &Micromodem::send_flexible, true},
             {"CCTFP", &Micromodem::send_framed, true}}};
  }

  void take_line(ClientId client, std::string_view line) {
    const NmeaSentence sentence = nmea_sentence(line);
    if (sentence.problem == NmeaSentence::Problem::kNoSentence)
      return core_.refuse(client, NmeaError::kUnknown, "no sentence");
    if (sentence.problem == NmeaSentence::Problem::kChecksum)
      return core_.refuse(client, NmeaError::kChecksum, "bad checksum");
    for (const Named& named : commands()) {
      if (named.id != sentence.id) continue;
      if (named.sends && !core_.can_send())
        return core_.refuse(client, NmeaError::kBusy, "transmit queue full");
      return (this->*named.command)(client, sentence);
    }
    if (remote_.obey(client, sentence) || lbl_.obey(client, sentence)) return;
    if (!housekeeping_.obey(client, sentence)) core_.refuse(client, NmeaError::kUnknown, "unknown command");
  }

  void begin_cycle(ClientId client, const NmeaSentence& sentence) {
    const auto n = sentence.numbers<6>();
    if (!n || sentence.fields.size() != 6) return core_.refuse_argument(client, sentence);
    const MicromodemCycle cycle{(*n)[0], (*n)[1], (*n)[2], (*n)[3], (*n)[4], (*n)[5]};
    const bool is_possible =
        cycle.source <= MicromodemCore::kHighestAddress && cycle.wants_ack <= 1 &&
        cycle.destination <= MicromodemCore::kHighestAddress && cycle.rate < kMicromodemRates &&
        cycle.frames >= 1 && cycle.frames <= micromodem_rate(static_cast<int>(cycle.rate)).max_frames &&
        (cycle.source == core_.own_address() || can_be_asked_for(cycle, core_.own_address()));
    if (!is_possible) return core_.refuse_argument(client, sentence);
    if (transmitter_.is_busy()) return core_.refuse(client, NmeaError::kBusy, "cycle under way");
    core_.echo(client, sentence);
    if (cycle.source == core_.own_address())
      return transmitter_.begin(cycle, core_.vehicle_of(cycle.destination), cycle.rate == 0);
    // When another modem is to send, a cycle packet asks it to.
    transmitter_.send({Kind::kCycle, core_.vehicle_of(cycle.source), cycle.source,
                       cycle_packet(cycle, core_.own_address())},
                      mini_packet(MicromodemKind::kCycle));
  }

  // Answers a cycle packet that asks this modem for data.
  void follow_cycle(const modem_receive_t& packet) {
    const Listener listener = core_.listener();
    const auto asked =
        cycle_in(packet.payload, listener.address(packet.source_id), listener.address(packet.destination_id));
    if (!asked || !asked->asks_for_data || transmitter_.is_busy()) return;
    const MicromodemCycle& cycle = asked->cycle;
    if (cycle.frames <= micromodem_rate(static_cast<int>(cycle.rate)).max_frames)
      transmitter_.begin(cycle, core_.vehicle_of(cycle.destination), false);
  }

  void take_hex(ClientId client, const NmeaSentence& sentence) {
    const auto data = bytes_of_hex(sentence.field(3));
    if (!data || sentence.fields.size() != 4) return core_.refuse_argument(client, sentence);
    take_data(client, sentence, std::move(*data));
  }
  // Rejoins the fields after the third with commas: text may contain them.
  void take_text(ClientId client, const NmeaSentence& sentence) {
    if (sentence.fields.size() < 4) return core_.refuse_argument(client, sentence);
    std::string text(sentence.field(3));
    for (std::size_t i = 4; i < sentence.fields.size(); ++i) text += "," + std::string(sentence.fields[i]);
    take_data(client, sentence, as_bytes(text));
  }
  void take_data(ClientId client, const NmeaSentence& sentence, std::vector<std::uint8_t> data) {
    const auto n = sentence.numbers<3>();
    if (!n || (*n)[2] > 1 || !transmitter_.can_take(data.size()))
      return core_.refuse_argument(client, sentence);
    core_.say(client,
              fmt::format("CA{},{},{},{},{}", sentence.id.substr(2), (*n)[0], (*n)[1], (*n)[2], data.size()));
    transmitter_.take_data(std::move(data), (*n)[2] != 0);
  }

  void send_mini(ClientId client, const NmeaSentence& sentence) {
    const auto n = sentence.numbers<2>();
    auto data = bytes_of_hex(sentence.field(2));
    if (!n || !data || data->size() != 2 || (*data)[0] > 0x1f) return core_.refuse_argument(client, sentence);
    core_.echo(client, sentence);
    transmitter_.send({Kind::kMini, core_.vehicle_of((*n)[1]), (*n)[1], std::move(*data)},
                      mini_packet(MicromodemKind::kPlain));
  }

  bool can_be_pinged(std::int32_t vehicle_id) const {
    return vehicle_id != kBroadcastId && vehicle_id != core_.vehicle_id();
  }
  void ping(ClientId client, const NmeaSentence& sentence) {
    const auto n = sentence.numbers<2>();
    const std::int32_t to = n ? core_.vehicle_of((*n)[1]) : kBroadcastId;
    if (!can_be_pinged(to)) return core_.refuse_argument(client, sentence);
    core_.echo(client, sentence);
    transmitter_.send({Kind::kPing, to, (*n)[1], {}}, {.kind = modem_send_t::PING, .rate_number = 0});
  }

  // Handles CCCMD,PNG,src,dest,rate,cdr,data, the ping of the second generation. Its data is not transmitted;
  // the answer to the host contains its number of bytes.
  void command(ClientId client, const NmeaSentence& sentence) {
    const auto n = sentence.numbers<4>(1);
    const std::int32_t to = n ? core_.vehicle_of((*n)[1]) : kBroadcastId;
    const bool is_possible =
        sentence.field(0) == "PNG" && n && (*n)[2] < kMicromodemRates && can_be_pinged(to);
    if (!is_possible) return core_.refuse_argument(client, sentence);
    const auto [source, destination, rate, cdr] = *n;
    const auto data = bytes_of_hex(sentence.field(5));
    core_.say(client, fmt::format("CACMD,PNG,{},{},{},{},{}", source, destination, rate, cdr,
                                  data ? std::to_string(data->size()) : sentence.field(5)));
    transmitter_.send({Kind::kNewPing, to, destination, {}},
                      {.kind = modem_send_t::PING,
                       .rate_number = static_cast<std::int32_t>(rate),
                       .header_number = static_cast<int>(MicromodemKind::kNewPing)});
  }

  // Handles CCTDP,dest,rate,ack,0,HEX. The fourth field is echoed without being examined.
  void send_flexible(ClientId client, const NmeaSentence& sentence) {
    const auto n = sentence.numbers<3>();
    auto data = bytes_of_hex(sentence.field(4));
    if (!n || !data || data->empty() || (*n)[1] >= kMicromodemRates || (*n)[2] > 1)
      return core_.refuse_argument(client, sentence);
    const auto [destination, rate, ack] = *n;
    core_.say(client,
              fmt::format("CATDP,0,{},{},{},{},{}", destination, rate, ack, sentence.field(3), data->size()));
    send_packet(Kind::kFlexible, MicromodemKind::kFlexible, destination, std::move(*data),
                {.wants_ack = ack == 1, .rate_number = static_cast<std::int32_t>(rate)});
  }

  // Handles CCTFP,dest,mini_rate,data_rate,ack,0,HEX,HEX with the rates and bytes of the mini-frame and of
  // the data; firmware from version 3 on inserts 0,0 before them. The simulated medium has one rate per
  // packet: that of the data, if there is any.
  void send_framed(ClientId client, const NmeaSentence& sentence) {
    const std::size_t first = sentence.fields.size() == 9 ? 2 : 0;
    const auto n = sentence.numbers<4>(first);
    auto mini = bytes_of_hex(sentence.field(first + 5)), data = bytes_of_hex(sentence.field(first + 6));
    const bool is_possible = n && mini && data && !(mini->empty() && data->empty()) &&
                             (*n)[1] < kMicromodemRates && (*n)[2] < kMicromodemRates && (*n)[3] <= 1;
    if (!is_possible) return core_.refuse_argument(client, sentence);
    const auto [destination, mini_rate, data_rate, ack] = *n;
    core_.say(client, fmt::format("CATFP,0,{},{},{},{},0,{},{}", destination, mini_rate, data_rate, ack,
                                  mini->size(), data->size()));
    std::vector<std::int32_t> frames;
    const bool has_mini = !mini->empty();
    if (has_mini) frames.push_back(static_cast<std::int32_t>(mini->size()));
    const auto rate = static_cast<std::int32_t>(data->empty() ? mini_rate : data_rate);
    for (std::size_t begin = 0; begin < data->size();) {
      const std::size_t size =
          std::min(data->size() - begin,
                   static_cast<std::size_t>(micromodem_rate(static_cast<int>(rate)).frame_bytes));
      frames.push_back(static_cast<std::int32_t>(size));
      begin += size;
    }
    mini->insert(mini->end(), data->begin(), data->end());
    send_packet(has_mini ? Kind::kFramedMini : Kind::kFramed,
                has_mini ? MicromodemKind::kFramedMini : MicromodemKind::kFramed, destination,
                std::move(*mini),
                {.wants_ack = ack == 1, .rate_number = rate, .frame_bytes = std::move(frames)});
  }
  void send_packet(Kind kind, MicromodemKind number, std::int64_t destination, std::vector<std::uint8_t> data,
                   clients::SendOptions options) {
    const std::int32_t to = core_.vehicle_of(destination);
    options.wants_ack = options.wants_ack && to != kBroadcastId;
    options.header_number = static_cast<int>(number);
    transmitter_.send({kind, to, destination, std::move(data)}, std::move(options));
  }

  // Reports a PING_REPLY or an ACK to a packet that this modem sent.
  void take_answer(const modem_receive_t& packet) {
    if (lbl_.takes(packet)) return;
    const Listener listener = core_.listener();
    const auto sent = transmitter_.sent_as(packet.packet_sequence);
    if (packet.packet_kind == modem_receive_t::ACK)
      return core_.say_all(sent == Kind::kFramed || sent == Kind::kFramedMini
                               ? lines_of_framed_ack(listener, packet, sent == Kind::kFramedMini)
                               : lines_of_ack(listener, packet));
    std::vector<std::string> lines;
    const std::int32_t responder = listener.address(packet.source_id);
    const double one_way_s = packet.two_way_travel_time_s / 2;
    lines.push_back(sent == Kind::kNewPing
                        ? ping_answer(listener, packet, one_way_s)
                        : fmt::format("CAMPR,{},{},{:.4f}", responder, core_.own_address(), one_way_s));
    add_statistics(listener, packet, lines);
    core_.say_all(lines);
  }

  MicromodemCore core_;
  ProtocolPort& port_;
  MicromodemHousekeeping housekeeping_;
  MicromodemLbl lbl_;
  MicromodemTransmitter transmitter_;
  MicromodemRemote remote_;
  std::map<ClientId, LineReader> readers_;
};

}  // namespace

std::unique_ptr<Protocol> make_micromodem(ProtocolContext context) {
  return std::make_unique<Micromodem>(std::move(context));
}

}  // namespace halocline::modem_gateway
