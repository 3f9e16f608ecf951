// WHOI Micromodem, first and second generation: NMEA sentences, CC from the host, CA and SN from the modem.
//
// Options: `revision` (0.94.0.00 is the first generation, 2.0.31000 the second), `pps` (its clock has a pulse a second, modem_clock.h),
// `broadcast` (the address of all; 15 is another where no modem has been given it), `lbl` (addresses of up to
// four transponders, with / between), `newer_lines` (CARFP in the place of CARDP).
//
// Answers go to the host that asked, everything else to all. Left out: CCMEC to another modem, sleep (CCMSC with minutes), shifts and
// probes of CCMSQ, CCSWP: they are echoed.
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "clients/modem_gateway/protocols/fields.h"
#include "clients/modem_gateway/protocols/line_reader.h"
#include "clients/modem_gateway/protocols/micromodem_lbl.h"
#include "clients/modem_gateway/protocols/micromodem_receptions.h"
#include "clients/modem_gateway/protocols/micromodem_settings.h"
#include "clients/modem_gateway/protocols/micromodem_transmitter.h"
#include "clients/modem_gateway/protocols/modem_clock.h"
#include "clients/modem_gateway/protocols/nmea.h"
#include "clients/modem_gateway/protocols/protocols.h"
#include "core/check.h"
#include "core/names.h"

namespace halocline::modem_gateway {
namespace {

constexpr std::int64_t kHighestAddress = 127;
// The broadcast address of four bits, which software of the first generation uses.
constexpr std::int32_t kOfFourBits = 15;
constexpr SimDuration kRevisionPeriod = SimDuration::from_milliseconds(5000);
constexpr SimDuration kRebootTime = SimDuration::from_milliseconds(300);
constexpr int kNoiseValues = 14;

// Numbers of CAERR,...,NMEA.
enum class NmeaError { kChecksum = 1, kUnknown = 2, kArgument = 3, kBusy = 4 };

// Whole numbers of the fields from `first` on; none where one is no number or lies beyond 0 to 100000.
template <std::size_t count>
std::optional<std::array<std::int64_t, count>> numbers_in(const NmeaSentence& sentence,
                                                          std::size_t first = 0) {
  std::array<std::int64_t, count> numbers{};
  for (std::size_t i = 0; i < count; ++i) {
    const auto number = integer_in(sentence.field(first + i), 0, 100'000);
    if (!number) return std::nullopt;
    numbers[i] = *number;
  }
  return numbers;
}

// The sentence's fields as they came.
std::string joined(const NmeaSentence& sentence) {
  std::string text;
  for (const std::string_view field : sentence.fields) text += "," + std::string(field);
  return text;
}

class Micromodem : public Protocol {
 public:
  explicit Micromodem(ProtocolContext context)
      : port_(context.port),
        addresses_(context.addresses),
        vehicle_id_(context.vehicle_id),
        clock_(context.options.take_flag("pps", true)),
        lbl_(port_, [this](const MicromodemLbl::Times& times) { report_lbl(times); }),
        transmitter_(port_, {.say = [this](const std::string& body) { say_all(body); },
                             .state = [this] { return state(); },
                             .start = [this] { return start_of_transmission(); },
                             .reports_statistics = [this] { return reports_transmissions(); },
                             .own_address = [this] { return own_address(); }}) {
    DoorOptions& options = context.options;
    revision_ = options.take("revision", "2.0.31000");
    const auto parts = fields_of(revision_, '.');
    require(
        parts.size() >= 3 && parts.size() <= 4 &&
            std::all_of(parts.begin(), parts.end(),
                        [](std::string_view part) { return integer_in(part, 0, 1'000'000'000).has_value(); }),
        "option revision is '" + revision_ +
            "'; allowed are three or four numbers, as 0.94.0.00 and 2.0.31000");
    is_second_generation_ = integer_in(parts[0], 0, 1'000'000'000) >= 2;
    broadcast_ = static_cast<std::int32_t>(options.take_number("broadcast", 0, 0, kHighestAddress));
    has_newer_lines_ = options.take_flag("newer_lines", false);
    read_transponders(options.take("lbl", ""));
    options.require_all_taken();
  }

  std::optional<clients::ListenOptions> listening() const override {
    return clients::ListenOptions{.wakes = {}, .promiscuous = true, .events = true};
  }

  void on_bytes(ClientId client, std::string_view bytes) override {
    readers_[client].take(
        bytes, [&](std::string_view line) { obey(client, line); },
        [&] { refuse(client, NmeaError::kUnknown, "line too long"); });
  }
  void on_closed(ClientId client) override { readers_.erase(client); }

  void on_receipt(const modem_receipt_t& receipt) override {
    if (!lbl_.takes(receipt)) transmitter_.on_receipt(receipt);
  }

  void on_packet(const modem_receive_t& packet) override {
    last_noise_db_ = packet.noise_level_db;
    if (port_.is_own(packet.send_session) && packet.destination_id == vehicle_id_) return take_answer(packet);
    if (packet.packet_kind == modem_receive_t::PING_REPLY || packet.packet_kind == modem_receive_t::ACK)
      return;
    say_all(lines_of(listener(), packet));
    if (packet.packet_kind == modem_receive_t::MINI_PACKET && !packet.stamped) follow_cycle(packet);
  }

  void on_loss(const packet_outcome_t& loss) override {
    last_noise_db_ = loss.noise_level_db;
    say_all(lines_of(listener(), loss));
  }

  SimTime next() const override {
    const SimTime revision = settings_.is_on("REV") ? next_revision_ : SimTime::never();
    return std::min({revision, reboots_, lbl_.next(), transmitter_.next(), noise_due_});
  }
  void step() override {
    const SimTime now = port_.now();
    if (now >= reboots_) {
      reboots_ = SimTime::never();
      say_revision("INIT");
      say_revision("AUV");
    }
    if (settings_.is_on("REV") && now >= next_revision_) {
      next_revision_ = now + kRevisionPeriod;
      say_revision("AUV");
    }
    if (now >= noise_due_) report_noise();
    lbl_.step();
    transmitter_.step(settings_.number("DTO"));
  }

 private:
  using Command = void (Micromodem::*)(ClientId, const NmeaSentence&);
  struct Named {
    std::string_view id;
    Command command;
  };
  static constexpr std::array<Named, 18> commands() {
    return {{{"CCCFG", &Micromodem::configure},
             {"CCCFQ", &Micromodem::query},
             {"CCMSC", &Micromodem::sleep},
             {"CCCLK", &Micromodem::set_clock},
             {"CCTMS", &Micromodem::set_time},
             {"CCTMQ", &Micromodem::query_time},
             {"CCCYC", &Micromodem::begin_cycle},
             {"CCTXD", &Micromodem::take_hex},
             {"CCTXA", &Micromodem::take_text},
             {"CCMUC", &Micromodem::send_mini},
             {"CCMPC", &Micromodem::ping},
             {"CCCMD", &Micromodem::command},
             {"CCTDP", &Micromodem::send_flexible},
             {"CCPDT", &Micromodem::range_digital},
             {"CCPNT", &Micromodem::range_narrow_band},
             {"CCCFR", &Micromodem::query_noise},
             {"CCMEC", &Micromodem::echo},
             {"CCSWP", &Micromodem::echo}}};
  }

  void say(ClientId client, const std::string& body) { port_.write(client, nmea_line(body)); }
  void say_all(const std::string& body) { say(kAllClients, body); }
  void say_all(const std::vector<std::string>& bodies) {
    for (const std::string& body : bodies) say_all(body);
  }
  void say_revision(const char* who) {
    say_all(fmt::format("CAREV,{},{},{}", clock_.hhmmss(port_.now()), who, revision_));
  }
  void refuse(ClientId client, NmeaError error, std::string_view text) {
    say(client,
        fmt::format("CAERR,{},NMEA,{},{}", clock_.hhmmss(port_.now()), static_cast<int>(error), text));
  }

  std::int32_t own_address() const { return addresses_.address_of(vehicle_id_).value_or(0); }
  std::int32_t vehicle_of(std::int64_t address) const {
    const auto number = static_cast<std::int32_t>(address);
    const bool is_all = number == broadcast_ || (number == kOfFourBits && !addresses_.is_given(number));
    return is_all ? kBroadcastId : addresses_.vehicle_of(number);
  }
  ReporterState state() const {
    return {clock_, is_second_generation_, static_cast<int>(settings_.number("AGN")),
            static_cast<int>(settings_.number("FC0"))};
  }
  Listener listener() const {
    return {state(),         addresses_, broadcast_, settings_.is_on("RXP"), settings_.is_on("CST"),
            has_newer_lines_};
  }
  SimTime start_of_transmission() const {
    return settings_.is_on("SNV") ? clock_.next_second(port_.now()) : port_.now();
  }
  bool reports_transmissions() const { return is_second_generation_ || settings_.is_on("XST"); }

  void read_transponders(const std::string& text) {
    if (text.empty()) return;
    const auto parts = fields_of(text, '/');
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const auto address = integer_in(parts[i], 1, kHighestAddress);
      require(i < kTransponders && address,
              "option lbl is '" + text + "'; allowed are up to four addresses from 1 to 127 with / between");
      transponders_[i] = static_cast<std::int32_t>(*address);
    }
  }

  void obey(ClientId client, std::string_view line) {
    const NmeaSentence sentence = nmea_sentence(line);
    if (sentence.problem == NmeaSentence::Problem::kNoSentence)
      return refuse(client, NmeaError::kUnknown, "no sentence");
    if (sentence.problem == NmeaSentence::Problem::kChecksum)
      return refuse(client, NmeaError::kChecksum, "bad checksum");
    for (const Named& named : commands()) {
      if (named.id == sentence.id) return (this->*named.command)(client, sentence);
    }
    if (sentence.id == "CCMSQ" || sentence.id == "CCRSP") return echo(client, sentence);
    refuse(client, NmeaError::kUnknown, "unknown command");
  }

  void echo(ClientId client, const NmeaSentence& sentence) {
    say(client, "CA" + std::string(sentence.id.substr(2)) + joined(sentence));
  }
  void refuse_argument(ClientId client, const NmeaSentence& sentence) {
    refuse(client, NmeaError::kArgument, "bad argument of " + std::string(sentence.id));
  }

  void configure(ClientId client, const NmeaSentence& sentence) {
    const std::string_view name = sentence.field(0), value = sentence.field(1);
    if (name.empty() || sentence.fields.size() != 2) return refuse_argument(client, sentence);
    if (name == "SRC") {
      const auto address = integer_in(value, 0, kHighestAddress);
      if (!address) return refuse_argument(client, sentence);
      addresses_.assign(vehicle_id_, static_cast<std::int32_t>(*address));
    }
    if (name == "ALL")
      settings_.reset();
    else if (settings_.all().size() < kMaxSettings || settings_.all().contains(name))
      settings_.set(name, value);
    if (name == "REV") next_revision_ = port_.now() + kRevisionPeriod;
    echo(client, sentence);
  }

  void query(ClientId client, const NmeaSentence& sentence) {
    const std::string_view name = sentence.field(0);
    if (name.empty()) return refuse_argument(client, sentence);
    const auto answer = [&](std::string_view key) {
      const std::string value = key == "SRC" ? std::to_string(own_address()) : settings_.value(key);
      say(client, fmt::format("CACFG,{},{}", key, value));
    };
    if (name != "ALL" && name != "TOP") return answer(name);
    for (const auto& [key, value] : settings_.all()) answer(key);
    if (!settings_.all().contains("SRC")) answer("SRC");
  }

  void sleep(ClientId client, const NmeaSentence& sentence) {
    const auto minutes = numbers_in<1>(sentence, 2);
    if (!minutes) return refuse_argument(client, sentence);
    echo(client, sentence);
    if (minutes->front() == 0)
      reboots_ = port_.now() + kRebootTime;
    else
      port_.note("not-simulated", "command=CCMSC: the modem stays awake");
  }

  void set_clock(ClientId client, const NmeaSentence& sentence) {
    const auto n = numbers_in<6>(sentence);
    const auto time =
        n ? calendar_seconds((*n)[0], (*n)[1], (*n)[2], (*n)[3], (*n)[4], (*n)[5]) : std::nullopt;
    if (!time) return refuse_argument(client, sentence);
    clock_.set(port_.now(), *time);
    say(client, "CACLK," + clock_.comma_separated(port_.now()));
  }

  void set_time(ClientId client, const NmeaSentence& sentence) {
    const auto time = calendar_seconds(sentence.field(0));
    if (!time) return refuse_argument(client, sentence);
    clock_.set(port_.now(), *time);
    say(client, "CATMS,0," + std::string(sentence.field(0)));
  }

  void query_time(ClientId client, const NmeaSentence&) {
    say(client, fmt::format("CATMQ,{},{},{}", clock_.iso(port_.now()), clock_.is_set() ? "USER" : "NONE",
                            clock_.has_pps() ? "EXT" : "NONE"));
  }

  void begin_cycle(ClientId client, const NmeaSentence& sentence) {
    const auto n = numbers_in<6>(sentence);
    if (!n || sentence.fields.size() != 6) return refuse_argument(client, sentence);
    const auto [command, source, destination, rate, ack, frames] = *n;
    const bool is_possible = source <= kHighestAddress && destination <= kHighestAddress && ack <= 1 &&
                             rate < kMicromodemRates && frames >= 1 &&
                             frames <= micromodem_rate(static_cast<int>(rate)).max_frames;
    if (!is_possible) return refuse_argument(client, sentence);
    if (transmitter_.is_busy()) return refuse(client, NmeaError::kBusy, "cycle under way");
    echo(client, sentence);
    const MicromodemCycle cycle{command, source, destination, rate, ack, frames};
    if (source == own_address()) return transmitter_.begin(cycle, vehicle_of(destination), rate == 0);
    // Another is to send: a cycle packet tells it.
    transmitter_.send({.packet = MicromodemTransmitter::Kind::kCycle,
                       .to = vehicle_of(source),
                       .destination = source,
                       .payload = cycle_packet(cycle, true)},
                      {.kind = modem_send_t::MINI_PACKET, .stamped = false, .rate_number = 0});
  }

  // A cycle packet that asks this modem for data.
  void follow_cycle(const modem_receive_t& packet) {
    const auto asked = cycle_in(packet.payload, listener().address(packet.source_id),
                                listener().address(packet.destination_id));
    if (!asked || !asked->asks_for_data || packet.destination_id != vehicle_id_ || transmitter_.is_busy())
      return;
    const MicromodemCycle& cycle = asked->cycle;
    if (cycle.frames <= micromodem_rate(static_cast<int>(cycle.rate)).max_frames)
      transmitter_.begin(cycle, vehicle_of(cycle.destination), false);
  }

  void take_hex(ClientId client, const NmeaSentence& sentence) {
    const auto data = bytes_of_hex(sentence.field(3));
    if (!data || sentence.fields.size() != 4) return refuse_argument(client, sentence);
    take_data(client, sentence, *data);
  }
  // Text may hold commas.
  void take_text(ClientId client, const NmeaSentence& sentence) {
    if (sentence.fields.size() < 4) return refuse_argument(client, sentence);
    std::string text(sentence.field(3));
    for (std::size_t i = 4; i < sentence.fields.size(); ++i) text += "," + std::string(sentence.field(i));
    take_data(client, sentence, as_bytes(text));
  }
  void take_data(ClientId client, const NmeaSentence& sentence, const std::vector<std::uint8_t>& data) {
    const auto n = numbers_in<3>(sentence);
    if (!n || (*n)[2] > 1 || !transmitter_.wants_data(data.size())) return refuse_argument(client, sentence);
    say(client,
        fmt::format("CA{},{},{},{},{}", sentence.id.substr(2), (*n)[0], (*n)[1], (*n)[2], data.size()));
    transmitter_.take_data(data, (*n)[2] != 0);
  }

  void send_mini(ClientId client, const NmeaSentence& sentence) {
    const auto n = numbers_in<2>(sentence);
    auto data = bytes_of_hex(sentence.field(2));
    if (!n || !data || data->size() != 2 || (*data)[0] > 0x1f) return refuse_argument(client, sentence);
    echo(client, sentence);
    transmitter_.send({.packet = MicromodemTransmitter::Kind::kMini,
                       .to = vehicle_of((*n)[1]),
                       .destination = (*n)[1],
                       .payload = std::move(*data)},
                      {.kind = modem_send_t::MINI_PACKET, .rate_number = 0});
  }

  void ping(ClientId client, const NmeaSentence& sentence) {
    const auto n = numbers_in<2>(sentence);
    const std::int32_t to = n ? vehicle_of((*n)[1]) : kBroadcastId;
    if (to == kBroadcastId || to == vehicle_id_) return refuse_argument(client, sentence);
    echo(client, sentence);
    transmitter_.send(
        {.packet = MicromodemTransmitter::Kind::kPing, .to = to, .destination = (*n)[1], .payload = {}},
        {.kind = modem_send_t::PING, .rate_number = 0});
  }

  // CCCMD,PNG,src,dest,rate,cdr,nbytes: the second generation's ping.
  void command(ClientId client, const NmeaSentence& sentence) {
    const auto n = numbers_in<3>(sentence, 1);
    const std::int32_t to = n ? vehicle_of((*n)[1]) : kBroadcastId;
    const bool is_possible = sentence.field(0) == "PNG" && n && (*n)[2] < kMicromodemRates &&
                             to != kBroadcastId && to != vehicle_id_;
    if (!is_possible) return refuse_argument(client, sentence);
    echo(client, sentence);
    transmitter_.send(
        {.packet = MicromodemTransmitter::Kind::kNewPing, .to = to, .destination = (*n)[1], .payload = {}},
        {.kind = modem_send_t::PING, .stamped = false, .rate_number = static_cast<std::int32_t>((*n)[2])});
  }

  // CCTDP,dest,rate,ack,0,HEX.
  void send_flexible(ClientId client, const NmeaSentence& sentence) {
    const auto n = numbers_in<4>(sentence);
    auto data = bytes_of_hex(sentence.field(4));
    if (!n || !data || data->empty() || (*n)[1] >= kMicromodemRates || (*n)[2] > 1)
      return refuse_argument(client, sentence);
    const auto [destination, rate, ack, reserved] = *n;
    const std::int32_t to = vehicle_of(destination);
    say(client, fmt::format("CATDP,0,{},{},{},{},{}", destination, rate, ack, reserved, data->size()));
    transmitter_.send({.packet = MicromodemTransmitter::Kind::kFlexible,
                       .to = to,
                       .destination = destination,
                       .payload = std::move(*data)},
                      {.stamped = false,
                       .wants_ack = ack == 1 && to != kBroadcastId,
                       .rate_number = static_cast<std::int32_t>(rate)});
  }

  // CCPDT,group,channel,sync,pps_to,timeout_ms,a,b,c,d: which of the four transponders.
  void range_digital(ClientId client, const NmeaSentence& sentence) { range(client, sentence, 4, 5); }
  // CCPNT,ftx,ttx,trx,timeout_ms,fa,fb,fc,fd,flag: frequencies of their answers, 0 where not used.
  void range_narrow_band(ClientId client, const NmeaSentence& sentence) { range(client, sentence, 3, 4); }
  void range(ClientId client, const NmeaSentence& sentence, std::size_t timeout_at, std::size_t first) {
    const auto timeout = numbers_in<1>(sentence, timeout_at);
    const auto wanted = numbers_in<kTransponders>(sentence, first);
    if (!timeout || !wanted) return refuse_argument(client, sentence);
    if (lbl_.is_busy()) return refuse(client, NmeaError::kBusy, "ranging under way");
    say(client, "SN" + std::string(sentence.id.substr(2)) + joined(sentence));
    MicromodemLbl::Asked asked;
    for (std::size_t i = 0; i < kTransponders; ++i) {
      if ((*wanted)[i] != 0 && transponders_[i]) asked[i] = addresses_.vehicle_of(*transponders_[i]);
    }
    lbl_.start(asked, SimDuration::from_milliseconds(timeout->front()));
  }
  void report_lbl(const MicromodemLbl::Times& times) {
    std::string body = "SNTTA";
    for (const auto& time : times) body += time ? fmt::format(",{:.4f}", *time) : ",";
    say_all(body + "," + clock_.hhmmss(port_.now(), 2));
  }

  // CCCFR,ms: the noise after so long; one band of this modem stands for all.
  void query_noise(ClientId client, const NmeaSentence& sentence) {
    const auto wait = numbers_in<1>(sentence);
    if (!wait) return refuse_argument(client, sentence);
    echo(client, sentence);
    noise_due_ = port_.now() + SimDuration::from_milliseconds(wait->front());
  }
  void report_noise() {
    noise_due_ = SimTime::never();
    std::string body = "SNCFR";
    for (int i = 0; i < kNoiseValues; ++i) body += fmt::format(",{:.0f}", last_noise_db_);
    say_all(body);
  }

  // A PING_REPLY or an ACK to a packet of this door.
  void take_answer(const modem_receive_t& packet) {
    if (lbl_.takes(packet)) return;
    if (packet.packet_kind == modem_receive_t::ACK) return say_all(lines_of_ack(listener(), packet));
    std::vector<std::string> lines;
    const std::int32_t responder = listener().address(packet.source_id);
    const double one_way_s = packet.two_way_travel_time_s / 2;
    lines.push_back(transmitter_.is_new_ping(packet.packet_sequence)
                        ? fmt::format("CACMR,PNR,{},{},{},{:.6f},{:.0f},,,,",
                                      clock_.iso(SimTime::from_utime(packet.arrival_utime)), responder,
                                      own_address(), one_way_s, packet.snr_db)
                        : fmt::format("CAMPR,{},{},{:.4f}", responder, own_address(), one_way_s));
    add_statistics(listener(), packet, lines);
    say_all(lines);
  }

  static constexpr std::size_t kMaxSettings = 1000;

  ProtocolPort& port_;
  AddressBook& addresses_;
  std::int32_t vehicle_id_;
  ModemClock clock_;
  std::string revision_;
  bool is_second_generation_ = true, has_newer_lines_ = false;
  std::int32_t broadcast_ = 0;
  std::array<std::optional<std::int32_t>, kTransponders> transponders_;
  MicromodemSettings settings_;
  MicromodemLbl lbl_;
  MicromodemTransmitter transmitter_;
  std::map<ClientId, LineReader> readers_;
  SimTime next_revision_, reboots_ = SimTime::never(), noise_due_ = SimTime::never();
  double last_noise_db_ = 0;
};

}  // namespace

std::unique_ptr<Protocol> make_micromodem(ProtocolContext context) {
  return std::make_unique<Micromodem>(std::move(context));
}

}  // namespace halocline::modem_gateway
