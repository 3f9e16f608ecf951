// SPDX-License-Identifier: BSD-3-Clause
// An ocean field for tests.
#pragma once

#include <cmath>
#include <cstddef>
#include <memory>

#include "acoustics/sea/environment.h"
#include "ocean/ocean_field.h"

namespace halocline::channel_server::testing {

inline constexpr double kMetresPerRadian = 6'371'000;

// Columns 1 km apart about the origin on the equator, at 0 and 3600 s; warmer with time and towards the
// north.
inline acoustics::Environment warming_sea(double per_hour, double per_km) {
  ocean::OceanGrid grid{{0, 3600}, {0, 30, 60, 200}, {}, {}};
  for (int i = -4; i <= 4; ++i) {
    grid.latitudes_rad.push_back(1000.0 * i / kMetresPerRadian);
    grid.longitudes_rad.push_back(1000.0 * i / kMetresPerRadian);
  }
  ocean::OceanValues values;
  for (const double time : grid.times_s) {
    for (const double depth : grid.depths_m) {
      for (const double north : grid.latitudes_rad) {
        for (std::size_t east = 0; east < grid.longitudes_rad.size(); ++east) {
          const double warmer = per_hour * time / 3600 + per_km * north * kMetresPerRadian / 1000;
          values.temperature_degc.push_back(
              static_cast<float>(16 - depth / 40 + warmer * std::exp(-depth / 60)));
          values.salinity_psu.push_back(35);
        }
      }
    }
  }
  acoustics::Environment sea;
  sea.field = {std::make_shared<const ocean::OceanField>(grid, values, ocean::GeodeticOrigin{0, 0}), 300,
               600};
  sea.profile = environment_at(sea, 0, 0).profile;
  return sea;
}

}  // namespace halocline::channel_server::testing
