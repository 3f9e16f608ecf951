// SPDX-License-Identifier: BSD-3-Clause
// States that the medium of a link holds through a packet, in predictions of frequency-shift keying
// (acoustics/reception/link_prediction.h).
#pragma once

#include <array>
#include <cstddef>

#include "acoustics/reception/mean_sound.h"
#include "acoustics/reception/signal_history.h"

namespace halocline::acoustics {

// Powers while the medium holds in one state, by frequency.
struct SlowSound {
  std::array<double, kSignalFrequencies> steady{}, varying{};
  double slow_power = 0;  // without what fades within a packet, over the band

  void scale(double factor);
};

// States of the medium: pressures that have its correlation, from complex normals of variance 1, by
// frequency.
inline constexpr std::size_t kMediumStates = 16;
struct MediumNormals {
  using States = std::array<double, kMediumStates>;
  std::array<States, kSignalFrequencies> re{}, im{};
};
std::array<SlowSound, kMediumStates> medium_states(const MeanSound& sound, const MediumNormals& normals);

}  // namespace halocline::acoustics
