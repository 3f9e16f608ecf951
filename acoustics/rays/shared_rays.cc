// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/shared_rays.h"

#include <cmath>

#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

double most_loss_db(const RayOptions& options) {
  return -20 * elementary::log10(options.min_boundary_factor);
}

}  // namespace

RayOptions widened(RayOptions options) {
  constexpr double kStepDb = 10;
  if (!(options.min_boundary_factor > 0)) return options;
  const double steps = std::ceil(most_loss_db(options) / kStepDb);
  options.min_boundary_factor = elementary::exp10(-steps * kStepDb / 20);
  return options;
}

void drop_faint(std::vector<Arrival>& paths, const RayOptions& options) {
  if (!(options.min_boundary_factor > 0)) return;
  std::erase_if(paths, [most_db = most_loss_db(options)](const Arrival& path) {
    return path.surface_loss_db + path.bottom_loss_db > most_db;
  });
}

}  // namespace halocline::acoustics
