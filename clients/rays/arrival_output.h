// Arrivals as people and programs read them: a table, CSV with the columns of the reference arrivals, or JSON.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "acoustics/arrivals.h"

namespace halocline::clients {

enum class OutputFormat { kTable, kCsv, kJson };

struct LinkArrivals {
  acoustics::RayLink link;
  acoustics::Arrivals arrivals;
};

// CSV: one row a path: src_depth_m, rcv_depth_m, rcv_range_m, index (by delay, from 0), delay_s, amplitude (re 1 m,
// without absorption), phase_deg (0..360), launch_angle_deg, arrival_angle_deg (positive down), n_surface, n_bottom,
// n_caustic, path_length_m, absorption_db, surface_loss_db, bottom_loss_db. A link in a shadow has no row.
// JSON: a list of links, each with its solver, shadow (true or false), summary and paths, by the same names.
void print_arrivals(std::ostream& out, const std::vector<LinkArrivals>& links, OutputFormat format);

}  // namespace halocline::clients
