// WHOI Micromodem, first and second generation: NMEA sentences, CC from the host, CA and SN from the modem.
//
// Options: `revision` (0.94.0.00 is the first generation, 2.0.31000 the second), `pps` (its clock has a pulse a second, modem_clock.h),
// `broadcast` (the address of all; 15 is another where no modem has been given it), `lbl` (addresses of up to four transponders, with /
// between), `newer_lines` (CARFP in the place of CARDP).
//
// Answers go to the host that asked, everything else to all. Left out: the sounds of CCMSQ and CCSWP; they are echoed.
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
#include "core/check.h"
#include "core/names.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {
namespace {

using Kind = MicromodemTransmitter::Kind;

class Micromodem : public Protocol {
 public:
  explicit Micromodem(ProtocolContext context)
      : core_(context),
        port_(context.port),
        addresses_(context.addresses),
        housekeeping_(core_),
        lbl_(port_, [this](const MicromodemLbl::Times& times) { report_lbl(times); }),
        transmitter_(core_),
        remote_(core_, transmitter_, housekeeping_) {
    read_transponders(context.options.take("lbl", ""));
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

  // CARXP: 0 frequency-shift, 1 phase-shift keying.
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
  };
  static constexpr std::array<Named, 10> commands() {
    return {{{"CCCYC", &Micromodem::begin_cycle},
             {"CCTXD", &Micromodem::take_hex},
             {"CCTXA", &Micromodem::take_text},
             {"CCMUC", &Micromodem::send_mini},
             {"CCMPC", &Micromodem::ping},
             {"CCCMD", &Micromodem::command},
             {"CCTDP", &Micromodem::send_flexible},
             {"CCPDT", &Micromodem::range_digital},
             {"CCPGT", &Micromodem::range_generic},
             {"CCPNT", &Micromodem::range_narrow_band}}};
  }

  void take_line(ClientId client, std::string_view line) {
    const NmeaSentence sentence = nmea_sentence(line);
    if (sentence.problem == NmeaSentence::Problem::kNoSentence)
      return core_.refuse(client, NmeaError::kUnknown, "no sentence");
    if (sentence.problem == NmeaSentence::Problem::kChecksum)
      return core_.refuse(client, NmeaError::kChecksum, "bad checksum");
    for (const Named& named : commands()) {
      if (named.id == sentence.id) return (this->*named.command)(client, sentence);
    }
    if (remote_.obey(client, sentence)) return;
    if (!housekeeping_.obey(client, sentence)) core_.refuse(client, NmeaError::kUnknown, "unknown command");
  }

  void read_transponders(const std::string& text) {
    if (text.empty()) return;
    const auto parts = fields_of(text, '/');
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const auto address = integer_in(parts[i], 1, MicromodemCore::kHighestAddress);
      require(i < kTransponders && address,
              "option lbl is '" + text + "'; allowed are up to four addresses from 1 to 127 with / between");
      transponders_[i] = static_cast<std::int32_t>(*address);
    }
  }

  void begin_cycle(ClientId client, const NmeaSentence& sentence) {
    const auto n = sentence.numbers<6>();
    if (!n || sentence.fields.size() != 6) return core_.refuse_argument(client, sentence);
    const MicromodemCycle cycle{(*n)[0], (*n)[1], (*n)[2], (*n)[3], (*n)[4], (*n)[5]};
    const bool is_possible = cycle.source <= MicromodemCore::kHighestAddress && cycle.wants_ack <= 1 &&
                             cycle.destination <= MicromodemCore::kHighestAddress &&
                             cycle.rate < kMicromodemRates && cycle.frames >= 1 &&
                             cycle.frames <= micromodem_rate(static_cast<int>(cycle.rate)).max_frames;
    if (!is_possible) return core_.refuse_argument(client, sentence);
    if (transmitter_.is_busy()) return core_.refuse(client, NmeaError::kBusy, "cycle under way");
    core_.echo(client, sentence);
    if (cycle.source == core_.own_address())
      return transmitter_.begin(cycle, core_.vehicle_of(cycle.destination), cycle.rate == 0);
    // Another is to send: a cycle packet tells it.
    transmitter_.send({Kind::kCycle, core_.vehicle_of(cycle.source), cycle.source, cycle_packet(cycle, true)},
                      mini_packet(MicromodemKind::kCycle));
  }

  // A cycle packet that asks this modem for data.
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
    take_data(client, sentence, *data);
  }
  // Text may hold commas.
  void take_text(ClientId client, const NmeaSentence& sentence) {
    if (sentence.fields.size() < 4) return core_.refuse_argument(client, sentence);
    std::string text(sentence.field(3));
    for (std::size_t i = 4; i < sentence.fields.size(); ++i) text += "," + std::string(sentence.fields[i]);
    take_data(client, sentence, as_bytes(text));
  }
  void take_data(ClientId client, const NmeaSentence& sentence, const std::vector<std::uint8_t>& data) {
    const auto n = sentence.numbers<3>();
    if (!n || (*n)[2] > 1 || !transmitter_.wants_data(data.size()))
      return core_.refuse_argument(client, sentence);
    core_.say(client,
              fmt::format("CA{},{},{},{},{}", sentence.id.substr(2), (*n)[0], (*n)[1], (*n)[2], data.size()));
    transmitter_.take_data(data, (*n)[2] != 0);
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

  // CCCMD,PNG,src,dest,rate,cdr,nbytes: the second generation's ping.
  void command(ClientId client, const NmeaSentence& sentence) {
    const auto n = sentence.numbers<3>(1);
    const std::int32_t to = n ? core_.vehicle_of((*n)[1]) : kBroadcastId;
    const bool is_possible =
        sentence.field(0) == "PNG" && n && (*n)[2] < kMicromodemRates && can_be_pinged(to);
    if (!is_possible) return core_.refuse_argument(client, sentence);
    core_.echo(client, sentence);
    transmitter_.send({Kind::kNewPing, to, (*n)[1], {}},
                      {.kind = modem_send_t::PING,
                       .rate_number = static_cast<std::int32_t>((*n)[2]),
                       .header_number = static_cast<int>(MicromodemKind::kNewPing)});
  }

  // CCTDP,dest,rate,ack,0,HEX.
  void send_flexible(ClientId client, const NmeaSentence& sentence) {
    const auto n = sentence.numbers<4>();
    auto data = bytes_of_hex(sentence.field(4));
    if (!n || !data || data->empty() || (*n)[1] >= kMicromodemRates || (*n)[2] > 1)
      return core_.refuse_argument(client, sentence);
    const auto [destination, rate, ack, reserved] = *n;
    const std::int32_t to = core_.vehicle_of(destination);
    core_.say(client, fmt::format("CATDP,0,{},{},{},{},{}", destination, rate, ack, reserved, data->size()));
    transmitter_.send({Kind::kFlexible, to, destination, std::move(*data)},
                      {.wants_ack = ack == 1 && to != kBroadcastId,
                       .rate_number = static_cast<std::int32_t>(rate),
                       .header_number = static_cast<int>(MicromodemKind::kFlexible)});
  }

  // CCPDT,group,channel,sync,pps_to,timeout_ms,a,b,c,d: which of the four transponders.
  void range_digital(ClientId client, const NmeaSentence& sentence) { range(client, sentence, 4, 5); }
  // CCPGT,ftx,bits,code,timeout_ms,frx,a,b,c,d,bandwidth,0: codes of their answers.
  void range_generic(ClientId client, const NmeaSentence& sentence) { range(client, sentence, 3, 5); }
  // CCPNT,ftx,ttx,trx,timeout_ms,fa,fb,fc,fd,flag: frequencies of their answers, 0 where not used.
  void range_narrow_band(ClientId client, const NmeaSentence& sentence) { range(client, sentence, 3, 4); }
  void range(ClientId client, const NmeaSentence& sentence, std::size_t timeout_at, std::size_t first) {
    const auto timeout = sentence.numbers<1>(timeout_at);
    const auto wanted = sentence.numbers<kTransponders>(first);
    if (!timeout || !wanted) return core_.refuse_argument(client, sentence);
    if (lbl_.is_busy()) return core_.refuse(client, NmeaError::kBusy, "ranging under way");
    core_.echo(client, sentence, "SN");
    MicromodemLbl::Asked asked;
    for (std::size_t i = 0; i < kTransponders; ++i) {
      if ((*wanted)[i] != 0 && transponders_[i]) asked[i] = addresses_.vehicle_of(*transponders_[i]);
    }
    lbl_.start(asked, SimDuration::from_milliseconds(timeout->front()));
  }
  void report_lbl(const MicromodemLbl::Times& times) const {
    std::string body = "SNTTA";
    for (const auto& time : times) body += time ? fmt::format(",{:.4f}", *time) : ",";
    core_.say_all(body + "," + core_.clock().hhmmss(core_.reading(), 2));
  }

  // A PING_REPLY or an ACK to a packet of this door.
  void take_answer(const modem_receive_t& packet) {
    if (lbl_.takes(packet)) return;
    const Listener listener = core_.listener();
    if (packet.packet_kind == modem_receive_t::ACK) return core_.say_all(lines_of_ack(listener, packet));
    std::vector<std::string> lines;
    const std::int32_t responder = listener.address(packet.source_id);
    const double one_way_s = packet.two_way_travel_time_s / 2;
    const std::string time = core_.clock().iso(SimTime::from_utime(packet.arrival_utime));
    lines.push_back(transmitter_.is_new_ping(packet.packet_sequence)
                        ? fmt::format("CACMR,PNR,{},{},{},{:.6f},{:.0f},,,,", time, responder,
                                      core_.own_address(), one_way_s, packet.snr_db)
                        : fmt::format("CAMPR,{},{},{:.4f}", responder, core_.own_address(), one_way_s));
    add_statistics(listener, packet, lines);
    core_.say_all(lines);
  }

  MicromodemCore core_;
  ProtocolPort& port_;
  AddressBook& addresses_;
  std::array<std::optional<std::int32_t>, kTransponders> transponders_;
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
