// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/modems/modem_config.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <mutex>
#include <utility>

#include "acoustics/modem/beam_pattern.h"
#include "bus/config/carried_files.h"
#include "channel_server/modems/built_in_modems.h"
#include "channel_server/vehicles/modem_rates.h"
#include "core/check.h"
#include "core/files/file_path.h"
#include "core/names.h"

namespace halocline::channel_server {
namespace {

// A profile other than the modem's resets all parameters to those of the profile.
void visit_profile(bus::ConfigVisitor& v, VehicleModem& m) {
  FilePath profile = m.profile;
  v.file(
      "profile", profile, bus::FileNames::kShipped,
      "profile with the defaults of the other keys: a file of models/modems by its name, or the path of one");
  if (v.writing() || profile == m.profile) return;
  bus::report_refusal(v, "profile", [&] {
    VehicleModem other = load_modem(profile);
    other.when_busy = m.when_busy;
    other.listening = m.listening;
    m = std::move(other);
  });
}

void visit_family(bus::ConfigVisitor& v, acoustics::Modem& a) {
  v.text("family", a.family, {}, "family of waveforms; modems receive those of their own family alone");
  if (!is_valid_name(a.family)) v.problem("family", "allowed is a name of " + std::string(kNameRule));
}

// Visits levels, band and bit rate.
void visit_signal(bus::ConfigVisitor& v, acoustics::Modem& a) {
  v.number("source_level_db", a.source_level.value, {0, 250, "dB re 1 uPa at 1 m", "source level"});
  v.number("cutoff_level_db", a.min_receivable_level.value,
           {-200, 250, "dB re 1 uPa", "minimum received level"});
  v.number("center_frequency_hz", a.centre_frequency_hz, {10, 1e6, "Hz", "centre of the band"});
  v.number("bandwidth_hz", a.bandwidth_hz, {1e-3, 2e6, "Hz", "width of the band, below twice its centre"});
  v.number("directivity_index_db", a.directivity_index.value,
           {0, 40, "dB", "directivity index of the receiver: gain over noise"});
  v.number("bit_rate_bps", a.bit_rate_bps, {1e-3, 1e7, "bit/s", "bit rate of the payload; generic alone"});
  bus::seconds(v, "packet_overhead_s", a.packet_overhead,
               {0, 60, "s", "duration of preamble and header; generic alone"});
}

// Visits framing and hopping, which only a profile's file may set.
void visit_framing(bus::ConfigVisitor& v, acoustics::Modem& a) {
  acoustics::FrameLayout& layout = a.layout;
  bus::integer_as(v, "preamble_pieces", a.preamble_pieces,
                  {1, 256, "", "pieces of the preamble, matched each and added without phase"});
  bus::integer_as(v, "header_bits", layout.header_bits, {0, 1e6, "bits", "coded block before the payload"});
  bus::integer_as(v, "tail_bits", layout.tail_bits, {0, 1e6, "bits", "bits that end each coded block"});
  bus::integer_as(v, "frame_bytes", layout.frame_bytes,
                  {0, 32768, "bytes", "bytes of a frame, which is sent whole; 0: no frames"});
  v.when(layout.frame_bytes > 0, "frame_bytes above 0", [&] {
    bus::integer_as(v, "max_frames", layout.max_frames, {0, 32, "", "maximum number of frames of a packet"});
  });
  bus::integer_as(v, "mini_packet_bits", layout.mini_packet_bits,
                  {0, 1e6, "bits", "bits of a mini-packet, addresses and check included; 0: there are none"});
  bus::integer_as(v, "application_bits", layout.application_bits,
                  {0, 1e6, "bits", "bits of the header that packets of kind JANUS carry; 0: there are none"});
  bus::seconds(v, "chip_s", a.chip, {0, 10, "s", "chip of frequency-hopped FSK; 0: no hopping"});
  bus::integer_as(v, "hop_count", a.hop_count, {0, 1024, "", "pairs of tones to hop between; 0: no hopping"});
  bus::seconds(
      v, "hop_clearing_s", a.hop_clearing,
      {0, 60, "s", "time after which the hop pattern may return to a pair of tones; earlier echoes miss it"});
}

// Visits what the receiver collects and loses: SINR = n S / (N 10^(loss / 10) + I).
void visit_receiver(bus::ConfigVisitor& v, acoustics::Modem& a) {
  bus::choice(v, "receiver", a.receiver, bus::names_of(acoustics::kReceiverKinds),
              "paths that the receiver collects: hops and equaliser those of the guard time");
  v.number("receiver_loss_db", a.receiver_loss.value,
           {acoustics::kMinReceiverLossDb, acoustics::kMaxReceiverLossDb, "dB",
            "loss of the receiver against the theory of its error_model"});
  bus::integer_as(v, "receiver_channels", a.receiver_channels,
                  {1, 64, "", "hydrophones that the receiver combines"});
  v.advanced([&] {
    v.number("late_echo_share", a.late_echo_share,
             {0, acoustics::kMaxLateEchoShare, "",
              "share of the power of an echo outside of the guard time that disturbs"});
    v.number("echo_cancelled", a.echo_cancelled,
             {0, 1, "", "share of such echoes that an equaliser takes away, of those it can track"});
    v.number("impulse_loss_db", a.impulse_loss.value,
             {0, 40, "dB", "further loss of the receiver where the sea's noise has impulses"});
  });
}

// Visits the parameters of reception above the cut-off level.
void visit_reception(bus::ConfigVisitor& v, acoustics::Modem& a) {
  bus::seconds(
      v, "preamble_s", a.preamble,
      {0, 60, "s", "preamble, the first part of the overhead, which is detected; 0: always detected"});
  bus::seconds(v, "guard_time_s", a.guard_time, {0, 10, "s", "delay up to which echoes add to the signal"});
  double taper_s = seconds_of(a.guard_taper);
  v.advanced([&] {
    v.number("guard_taper_s", taper_s,
             {-1, 10, "s", "time over which the weight of later echoes falls to 0; below 0: one guard time"});
    v.number("doppler_tolerance", a.doppler_tolerance,
             {0, 1, "", "maximum |f_rx / f_tx - 1| that is received without fading"});
    v.number("doppler_correction", a.doppler_correction,
             {0, 1, "", "maximum |f_rx / f_tx - 1| that is corrected with fading"});
    bus::seconds(v, "time_quantum_s", a.time_quantum, {0, 1, "s", "resolution of times of arrival; 0: none"});
  });
  a.guard_taper = taper_from(taper_s);
  bus::choice(v, "error_model", a.error_model, bus::names_of(acoustics::kErrorModels), "model of bit errors");
  visit_receiver(v, a);
}

// Visits the modem's rates, which only a profile's file may set.
void visit_rates(bus::ConfigVisitor& v, VehicleModem& m, std::vector<FilePath>& rates) {
  bus::integer_as(v, "rate_number", m.rate_number, {0, 255, "", "number by which a SEND names this rate"});
  v.files("rates", rates, bus::FileNames::kShipped,
          "other rates of the modem: profiles, as `profile` names them, with blanks between");
}

void visit_max_payload(bus::ConfigVisitor& v, VehicleModem& m) {
  bus::integer_as(v, "max_payload_bytes", m.max_payload_bytes,
                  {0, acoustics::kMaxPayloadBytes, "bytes", "largest payload of a packet"});
}

void visit_beam(bus::ConfigVisitor& v, acoustics::BeamPattern& beam) {
  std::vector<double> elevations_rad, losses_db;
  for (const acoustics::BeamRow& row : beam.rows()) {
    elevations_rad.push_back(row.elevation_rad);
    losses_db.push_back(row.loss_db);
  }
  bus::degrees(v, "beam_elevation_deg", elevations_rad,
               {-90, 90, "deg", "elevations of beam_loss_db, positive down, rising; none: omnidirectional"});
  v.numbers(
      "beam_loss_db", losses_db,
      {-60, 200, "dB", "loss of the transducer to source and cut-off level, in transmission and reception"});
  if (!v.given("beam_elevation_deg") && !v.given("beam_loss_db")) return;
  if (elevations_rad.size() != losses_db.size()) {
    return v.problem("beam_loss_db", "as many numbers as beam_elevation_deg has");
  }
  bus::report_refusal(v, "beam_elevation_deg", [&] {
    std::vector<acoustics::BeamRow> rows;
    for (std::size_t i = 0; i < losses_db.size(); ++i) {
      rows.push_back({elevations_rad[i], losses_db[i]});
    }
    beam = rows.empty() ? acoustics::BeamPattern() : acoustics::BeamPattern(std::move(rows));
  });
}

void visit_listening(bus::ConfigVisitor& v, Listening& listening) {
  v.boolean("promiscuous", listening.promiscuous, "true: RECEIVE also of packets for other vehicles");
  v.boolean("events", listening.events, "true: MODEM_EVENT of transmissions, detections and carrier");
  v.when(listening.events, "events = true",
         [&] { v.advanced([&] { visit_carrier_threshold(v, listening); }); });
}

// Checks the relations between several values.
void check_as_a_whole(bus::ConfigVisitor& v, const acoustics::Modem& a) {
  if (a.preamble > a.packet_overhead)
    v.problem("preamble_s", "at most packet_overhead_s, whose first part it is");
  if (a.bandwidth_hz >= 2 * a.centre_frequency_hz) {
    v.problem("bandwidth_hz", "the band reaches below 0 Hz; allowed is below twice center_frequency_hz");
  }
  if (!hops_well(a)) v.problem("hop_count", "allowed is 0, or a chip_s above 0");
}

// Gives the hops of the generic modem the chips of another bit rate: two a bit, by its code of rate 1/2.
void hop_at_rate(acoustics::Modem& a) {
  if (a.hop_count == 0) return;
  constexpr double kMaxChip_s = 10, kMaxGuard_s = 10;
  const double chips = a.hop_clearing.seconds() / a.chip.seconds();
  const double chip_s = std::min(0.5 / a.bit_rate_bps, kMaxChip_s);
  a.guard_time =
      SimDuration::from_seconds(std::min(a.guard_time.seconds() * chip_s / a.chip.seconds(), kMaxGuard_s));
  a.chip = SimDuration::from_seconds(chip_s);
  a.hop_clearing = SimDuration::from_seconds(chips * chip_s);
}

std::string names_for_errors() {
  std::string names;
  for (const ModemText& text : built_in_modem_texts()) names += std::string(text.name) + ", ";
  return names;
}

// Reads one modem from a file. The names of the profiles of its other rates go to `rates`.
VehicleModem read_modem(bus::ConfigFile& file, const FilePath& profile, std::vector<FilePath>& rates) {
  VehicleModem m;
  m.profile = profile;
  file.read([&](bus::ConfigVisitor& v) {
    visit_family(v, m.modem);
    visit_signal(v, m.modem);
    visit_max_payload(v, m);
    visit_reception(v, m.modem);
    visit_framing(v, m.modem);
    visit_rates(v, m, rates);
    visit_beam(v, m.modem.beam);
    check_as_a_whole(v, m.modem);
  });
  file.check(/*whole_file=*/true);
  validate(m.modem);
  m.max_payload_bytes = static_cast<std::int32_t>(largest_payload_bytes(m));
  return m;
}

// Returns the text of a built-in profile. Throws InvalidArgument for an unknown name.
std::string built_in_text(const std::string& profile) {
  for (const ModemText& text : built_in_modem_texts())
    if (profile == text.name) return text.toml;
  throw InvalidArgument("unknown modem profile '" + profile + "'; there are " + names_for_errors() +
                        "or a file .toml");
}

// A cache of built-in modems by name, each made at its first use. Thread-safe.
class KnownModems {
 public:
  template <class Make>
  const VehicleModem& of(const std::string& name, Make&& make) {
    const std::lock_guard lock(mutex_);
    if (const auto found = modems_.find(name); found != modems_.end()) return found->second;
    return modems_.emplace(name, make()).first->second;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, VehicleModem> modems_;
};

// Returns a built-in profile at its own rate only.
const VehicleModem& built_in_rate(const std::string& profile) {
  static KnownModems known;
  return known.of(profile, [&] {
    auto file = bus::ConfigFile::parse(built_in_text(profile), profile);
    std::vector<FilePath> rates;
    return read_modem(file, profile, rates);
  });
}

// Returns a profile, built in or from a file, at its own rate only.
VehicleModem one_rate(const FilePath& profile) {
  if (!bus::names_a_file(profile.place(), bus::FileNames::kShipped)) return built_in_rate(profile.place());
  auto file = bus::ConfigFile::load_named(profile);
  std::vector<FilePath> rates;
  return read_modem(file, profile, rates);
}

// Returns the profile in `file` with all its rates. A named rate with the profile's own number is the profile
// itself and is skipped.
VehicleModem with_rates(bus::ConfigFile& file, const FilePath& profile) {
  std::vector<FilePath> names;
  VehicleModem m = read_modem(file, profile, names);
  std::vector<ModemRate> rates;
  for (const FilePath& name : names) {
    const VehicleModem rate = one_rate(name);
    if (rate.rate_number == m.rate_number) continue;
    const auto taken = [&](const ModemRate& other) { return other.number == rate.rate_number; };
    require(std::none_of(rates.begin(), rates.end(), taken),
            profile.given() + ": two rates have the number " + std::to_string(rate.rate_number));
    rates.push_back({rate.rate_number, rate.max_payload_bytes, rate.modem});
  }
  std::sort(rates.begin(), rates.end(),
            [](const ModemRate& a, const ModemRate& b) { return a.number < b.number; });
  m.rates = rates_in_vehicle(RateSet(std::move(rates)), m.modem, m.modem);
  return m;
}

}  // namespace

void visit_carrier_threshold(bus::ConfigVisitor& v, Listening& listening) {
  v.number("carrier_threshold_db", listening.carrier_threshold.value,
           {0, 100, "dB", "events: level of other sound above the noise at which carrier is sensed"});
}

void visit_modem(bus::ConfigVisitor& v, VehicleModem& m) {
  acoustics::Modem& a = m.modem;
  visit_profile(v, m);
  v.advanced([&] { visit_family(v, a); });
  visit_signal(v, a);
  if (!v.writing() && m.profile == kGenericProfile && v.given("bit_rate_bps")) hop_at_rate(a);
  visit_max_payload(v, m);
  visit_reception(v, a);
  visit_beam(v, a.beam);
  bus::choice(v, "when_busy", m.when_busy, {"refuse", "queue"}, "reaction to a SEND during a transmission");
  visit_listening(v, m.listening);
  if (!v.writing() && m.profile != kGenericProfile) {
    bus::report_refusal(v, "profile", [&] { set_rates_of(load_modem(m.profile), m); });
  }
  check_as_a_whole(v, a);
}

std::optional<SimDuration> taper_from(double seconds) {
  return seconds < 0 ? std::nullopt : std::optional(SimDuration::from_seconds(seconds));
}

double seconds_of(std::optional<SimDuration> taper) { return taper ? taper->seconds() : -1; }

void set_rates_of(const VehicleModem& profile, VehicleModem& vehicle) {
  const acoustics::Modem& modem = vehicle.modem;
  const auto fixed = [&](bool same, const std::string& what) {
    require(same, what + " of profile " + profile.profile.given() +
                      " is its own; only the generic profile has another");
  };
  fixed(modem.bit_rate_bps == profile.modem.bit_rate_bps, "bit rate");
  fixed(modem.packet_overhead == profile.modem.packet_overhead, "packet overhead");
  fixed(modem.preamble == profile.modem.preamble, "preamble");
  vehicle.rates = rates_in_vehicle(profile.rates, profile.modem, modem);
}

const std::vector<std::string>& built_in_modems() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const ModemText& text : built_in_modem_texts()) list.emplace_back(text.name);
    // Files are in the order of their names with the ending, in which '-' comes before '.'.
    std::sort(list.begin(), list.end());
    return list;
  }();
  return names;
}

VehicleModem load_modem(const FilePath& profile) {
  if (bus::names_a_file(profile.place(), bus::FileNames::kShipped)) {
    auto file = bus::ConfigFile::load_named(profile);
    return with_rates(file, profile);
  }
  static KnownModems known;
  const std::string& name = profile.place();
  return known.of(name, [&] { return parse_modem(built_in_text(name), name); });
}

acoustics::Modem built_in_modem(const std::string& profile) { return built_in_rate(profile).modem; }

VehicleModem parse_modem(const std::string& text, const std::string& name_for_errors) {
  auto file = bus::ConfigFile::parse(text, name_for_errors);
  return with_rates(file, FilePath(name_for_errors));
}

}  // namespace halocline::channel_server
