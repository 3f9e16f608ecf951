#include "channel_server/modem_config.h"

#include "acoustics/modem/modem_profile.h"
#include "core/check.h"

namespace halocline::channel_server {
namespace {

// A profile or rate other than the modem's starts anew from the profile's numbers.
void visit_profile(bus::ConfigVisitor& v, VehicleModem& m) {
  const acoustics::Modem& a = m.modem;
  acoustics::ModemProfile profile = a.profile;
  bus::choice(v, "profile", profile, bus::names_of(acoustics::kModemProfiles),
              "whose numbers hold where the keys below are not given");
  std::int32_t rate = a.psk_rate;
  if (profile != a.profile) {
    rate = profile == acoustics::ModemProfile::kMicromodemPsk ? acoustics::kDefaultPskRate : 0;
  }
  bus::integer_as(v, "psk_rate", rate,
                  {0, 5, "", "packet type of micromodem-psk: 1, 2, 4 or 5; 0 elsewhere"});
  if (profile == a.profile && rate == a.psk_rate) return;
  bus::report_refusal(v, "psk_rate", [&] {
    m.modem = acoustics::profile_modem(profile, rate);
    require(m.modem.psk_rate == rate, "psk_rate is of micromodem-psk alone; allowed is 0");
  });
  m.max_payload_bytes = static_cast<std::int32_t>(largest_payload_bytes({.modem = m.modem}));
}

// How a packet is received, once it is strong enough.
void visit_reception(bus::ConfigVisitor& v, acoustics::Modem& a) {
  bus::seconds(v, "preamble_s", a.preamble,
               {0, 60, "s", "first part of the overhead, by which a packet is noticed; 0: always noticed"});
  bus::seconds(v, "guard_time_s", a.guard_time,
               {0, 10, "s", "echoes up to this late add to the signal, later ones interfere"});
  v.number("doppler_tolerance", a.doppler_tolerance, {0, 1, "", "greatest |f_rx / f_tx - 1| received"});
  bus::choice(v, "error_model", a.error_model, bus::names_of(acoustics::kErrorModels),
              "how often bits are wrong");
}

void visit_beam(bus::ConfigVisitor& v, acoustics::BeamPattern& beam) {
  std::vector<double> elevations_rad, losses_db;
  for (const acoustics::BeamRow& row : beam.rows()) {
    elevations_rad.push_back(row.elevation_rad);
    losses_db.push_back(row.loss_db);
  }
  bus::degrees(v, "beam_elevation_deg", elevations_rad,
               {-90, 90, "deg", "of beam_loss_db, positive down, rising; none: omnidirectional"});
  v.numbers("beam_loss_db", losses_db,
            {-60, 200, "dB", "of the transducer re source and cut-off level, sending and hearing"});
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

}  // namespace

void visit_modem(bus::ConfigVisitor& v, VehicleModem& m) {
  acoustics::Modem& a = m.modem;
  visit_profile(v, m);
  v.number("source_level_db", a.source_level.value, {0, 250, "dB re 1 uPa at 1 m", "strength"});
  v.number("cutoff_level_db", a.min_receivable_level.value,
           {-200, 250, "dB re 1 uPa", "least receivable level"});
  v.number("center_frequency_hz", a.centre_frequency_hz, {10, 1e6, "Hz", "centre of the band"});
  v.number("bandwidth_hz", a.bandwidth_hz, {1e-3, 2e6, "Hz", "width of the band, below twice its centre"});
  v.number("directivity_index_db", a.directivity_index.value, {0, 40, "dB", "gain of reception over noise"});
  v.number("bit_rate_bps", a.bit_rate_bps, {1e-3, 1e7, "bit/s", "of the payload; generic alone"});
  bus::seconds(v, "packet_overhead_s", a.packet_overhead,
               {0, 60, "s", "preamble and header of a packet; generic alone"});
  bus::integer_as(v, "max_payload_bytes", m.max_payload_bytes,
                  {0, 32768, "bytes", "largest payload of a packet"});
  visit_reception(v, a);
  visit_beam(v, a.beam);
  bus::choice(v, "when_busy", m.when_busy, {"refuse", "queue"}, "asked to send while sending");
  bus::report_refusal(v, "profile", [&] { validate_profile(a); });
  if (a.preamble > a.packet_overhead)
    v.problem("preamble_s", "at most packet_overhead_s, whose first part it is");
  if (a.bandwidth_hz >= 2 * a.centre_frequency_hz) {
    v.problem("bandwidth_hz", "the band reaches below 0 Hz; allowed is below twice center_frequency_hz");
  }
}

}  // namespace halocline::channel_server
