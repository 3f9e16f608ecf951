// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/modems/clock_config.h"

namespace halocline::channel_server {

void visit_clock(bus::ConfigVisitor& v, ClockSettings& clock) {
  double drift_ppm = clock.drift * 1e6;
  v.number("offset_s", clock.offset_s, {-1e5, 1e5, "s", "offset at time 0; above 0: ahead"});
  v.number("drift_ppm", drift_ppm, {-1000, 1000, "ppm", "rate error, above 0: fast; 1 ppm: 3.6 ms an hour"});
  clock.drift = drift_ppm * 1e-6;
  v.boolean("set_by_gps", clock.is_set_by_gps, "true: each GPS fix of the vehicle sets the clock");
  v.advanced([&] {
    v.number("random_walk_s_per_sqrt_s", clock.random_walk,
             {0, 1e-3, "s/sqrt(s)", "random walk of the reading: after t seconds this times sqrt(t)"});
    v.when(clock.is_set_by_gps, "set_by_gps = true", [&] {
      v.number("gps_residual_s", clock.gps_residual_s,
               {0, 1, "s", "standard deviation of the error when GPS has set the clock"});
    });
  });
}

}  // namespace halocline::channel_server
