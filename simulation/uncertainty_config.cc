// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/uncertainty_config.h"

namespace halocline::clients {
namespace {

void visit_spreads(bus::ConfigVisitor& v, Uncertainty& u) {
  if (v.writing() ? u.noise_db.has_value() : v.given("noise_db")) {
    double noise_db = u.noise_db.value_or(Uncertainty::kNoiseDb);
    v.number("noise_db", noise_db,
             {0, 30, "dB", "spread of the noise; 5 where it is not given, 10 for modems above 40 kHz"});
    u.noise_db = noise_db;
  }
  v.number("receiver_db", u.receiver_db, {0, 30, "dB", "spread of the receivers' own loss"});
  v.number("bottom_octaves", u.bottom_octaves,
           {0, 5, "", "spread of the bottom's roughness and slope, as a power of 2"});
  v.advanced([&] {
    v.number("wind_share", u.wind_share, {0, 1, "", "spread of the wind, as a share of it"});
    v.number("sediment_rows", u.sediment_rows,
             {0, 10, "", "spread of the sediment, in rows of the table from rock to clay"});
    v.number("profile_mps", u.profile_mps,
             {0, 10, "m/s", "spread of the amplitudes of two modes of the sound-speed profile"});
    v.number("noise_bottom_correlation", u.noise_bottom_correlation,
             {-1, 1, "", "correlation of the noise and the bottom's factor"});
  });
}

}  // namespace

void visit(bus::ConfigVisitor& v, Uncertainty& uncertainty) {
  v.section("uncertainty", "Spreads of what is not known of the sea, one standard deviation each",
            [&](bus::ConfigVisitor& s) { visit_spreads(s, uncertainty); });
}

}  // namespace halocline::clients
