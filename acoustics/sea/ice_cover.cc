// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/ice_cover.h"

#include <algorithm>

#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {

void validate(const IceCover& ice) {
  require_in_range(ice.roughness_m, 0, 5, "rms roughness of the ice", "m");
  require_in_range(ice.slope, 0, 1, "rms slope of the ice");
  require_in_range(ice.loss_db, 0, 20, "loss of a bounce under ice", "dB");
  require_in_range(ice.loss_per_sine_db, 0, 50, "loss of a bounce under ice per sine", "dB");
  require_in_range(ice.keels_per_km, 0, 100, "keels", "per km");
  require_in_range(ice.keel_draft_m, 0, 60, "draft of keels", "m");
}

double ice_loss_db(const IceCover& ice, double sine) { return ice.loss_db + ice.loss_per_sine_db * sine; }

double keel_loss_db_per_km(const IceCover& ice, double depth_m) {
  constexpr double kMaxTaken = 0.99;
  if (!ice.covers() || !(ice.keels_per_km > 0) || !(depth_m > 0)) return 0;
  const double taken = std::min(ice.keel_draft_m / depth_m, kMaxTaken);
  return -10 * elementary::log10(1 - taken) * ice.keels_per_km;
}

}  // namespace halocline::acoustics
