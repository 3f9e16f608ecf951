// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/rasters/vertical_sense.h"

#include "core/check.h"
#include "core/text/lower_case.h"

namespace halocline::bathymetry {

bool holds_depths(const std::string& positive, const std::string& standard_name,
                  const RasterOptions& options) {
  const std::string sense = lower_case(positive);
  const bool is_depth =
      standard_name.starts_with("depth") || standard_name.find("sea_floor_depth") != std::string::npos;
  const bool is_height =
      standard_name.starts_with("height") || standard_name.find("altitude") != std::string::npos;
  const bool down = sense == "down" || is_depth, up = sense == "up" || is_height;
  require(!(down && up), options.path.place() + ": positive is \"" + positive + "\" with the standard name " +
                             standard_name + ": they contradict each other");
  require(!(up && options.positive_down), options.path.place() + ": the file declares heights (positive \"" +
                                              positive + "\", standard name \"" + standard_name +
                                              "\"); allowed is positive_down = false");
  return down || options.positive_down;
}

}  // namespace halocline::bathymetry
