// SPDX-License-Identifier: BSD-3-Clause
// Output of arrivals as a table for readers, as CSV with the columns of the reference arrivals, or as JSON.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "acoustics/fading/arrival.h"
#include "acoustics/link/received_field.h"
#include "acoustics/rays/eigenray.h"

namespace halocline::clients {

enum class OutputFormat { kTable, kCsv, kJson };

// Spread of a link's paths in time, as in LINKS and `halocline link`.
struct DelaySpreads {
  double first_to_last_s = 0;  // from the first to the last significant path
  double rms_s = 0;            // about the power-weighted mean delay of all paths
};

// Paths of a link, and all that is known for their output.
struct LinkArrivals {
  acoustics::RayLink link;
  acoustics::Eigenrays eigenrays;
  bool modems_known = false;          // `received` has one element for each path
  acoustics::Transducers beams = {};  // beam patterns that weight the summary and the impulse response
  std::vector<acoustics::Arrival> received = {};
  bool blocked = false;                      // the bottom cuts the straight line, and no ray arrives
  std::string found_by = {};                 // empty: the solver's name
  std::optional<DelaySpreads> spreads = {};  // only with known modems
};

// Returns the level of a path: dB re 1 uPa at the receiver when the modems are known, otherwise dB re the
// source level.
double path_level_db(const LinkArrivals& found, std::size_t index);

// Returns why there is no path.
std::string why_silent(const LinkArrivals& found);

// Writes CSV with delay_s, real, imaginary and magnitude_db for each sample of acoustics::impulse_response
// about the carrier, from the sample before the first path to the one after the last. Pressure is relative to
// that at 1 m and includes the beam patterns. Without a path there is no row.
void print_impulse_response(std::ostream& out, const LinkArrivals& found, double carrier_hz, double rate_hz);

// Writes the eigenrays of several links.
//
// CSV has one row for each path; a link without a path has none. Columns:
//
//   src_depth_m, rcv_depth_m, rcv_range_m
//   index                                 from 0, in the order of delay
//   delay_s
//   amplitude                             re 1 m, without absorption
//   phase_deg                             0..360
//   launch_angle_deg, arrival_angle_deg   positive down
//   n_surface, n_bottom, n_caustic
//   path_length_m, absorption_db, surface_loss_db, bottom_loss_db
//   diffuse                               1: the total power of many weak paths in a window of angles
//   level_db, doppler_factor              only with known modems
//
// JSON is a list of links, each with its solver, shadow (true or false), summary and paths, with the same
// names; without a path it has the cause: shadow, blocked, too weak or too steep.
void print_arrivals(std::ostream& out, const std::vector<LinkArrivals>& links, OutputFormat format);

}  // namespace halocline::clients
