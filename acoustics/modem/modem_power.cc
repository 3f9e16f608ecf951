// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/modem/modem_power.h"

#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {

double transmit_power_w(const Modem& modem, double efficiency) {
  require_in_range(efficiency, 1e-3, 1, "efficiency of a transmitter");
  return elementary::exp10((modem.source_level.value - kLevelOfAWatt - modem.directivity_index.value) / 10) /
         efficiency;
}

}  // namespace halocline::acoustics
