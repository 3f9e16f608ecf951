// SPDX-License-Identifier: BSD-3-Clause
// Arrivals as people and programs read them: a table, CSV with the columns of the reference arrivals, or
// JSON.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "acoustics/link/received_field.h"
#include "acoustics/rays/arrivals.h"

namespace halocline::clients {

enum class OutputFormat { kTable, kCsv, kJson };

// What a receiver gets of one path from the transmitter's modem.
struct ReceivedPath {
  double level_db;        // dB re 1 uPa
  double doppler_factor;  // received over sent frequency
};

// How far the paths of a link are spread in time, as LINKS and `halocline link` have it.
struct DelaySpreads {
  double first_to_last_s = 0;  // from the first to the last significant path
  double rms_s = 0;            // about the mean of all paths, by power
};

struct LinkArrivals {
  acoustics::RayLink link;
  acoustics::Arrivals arrivals;
  bool modems_known = false;          // then `received` holds one for each path
  acoustics::Transducers beams = {};  // of the modems, which weigh summary and impulse response
  std::vector<ReceivedPath> received = {};
  bool blocked = false;                      // where no ray gets there: the bottom cuts the straight line
  std::string found_by = {};                 // empty: the solver's name
  std::optional<DelaySpreads> spreads = {};  // with known modems
};

// CSV: one row a path: src_depth_m, rcv_depth_m, rcv_range_m, index (by delay, from 0), delay_s, amplitude
// (re 1 m, without absorption), phase_deg (0..360), launch_angle_deg, arrival_angle_deg (positive down),
// n_surface, n_bottom, n_caustic, path_length_m, absorption_db, surface_loss_db, bottom_loss_db, diffuse (1:
// not one path, but the many weak ones of a window of angles, by their power); with known modems also
// level_db and doppler_factor. A link without a path has no row.
// JSON: a list of links, each with its solver, shadow (true or false), summary and paths, by the same
// names; without a path its cause: shadow, blocked, too weak or too steep.
// Level of a path: received, dB re 1 uPa, where the modems are known, else dB re the source level.
double path_level_db(const LinkArrivals& found, std::size_t index);

// Why there is no path.
std::string why_silent(const LinkArrivals& found);

// CSV: delay_s, real, imaginary and magnitude_db of each sample of acoustics::impulse_response about the
// carrier, from the sample before the first path to the one after the last; pressure re that at 1 m, beams in
// it. Without a path no row.
void print_impulse_response(std::ostream& out, const LinkArrivals& found, double carrier_hz, double rate_hz);

void print_arrivals(std::ostream& out, const std::vector<LinkArrivals>& links, OutputFormat format);

}  // namespace halocline::clients
