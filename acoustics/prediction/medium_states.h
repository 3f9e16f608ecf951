// SPDX-License-Identifier: BSD-3-Clause
// Realisations of the fading that the medium imposes on a link through a packet, for predictions of
// frequency-shift keying (acoustics/prediction/link_prediction.h).
#pragma once

#include <array>
#include <cstddef>

#include "acoustics/prediction/reception_statistics.h"
#include "acoustics/reception/signal_history.h"

namespace halocline::acoustics {

// Powers at each frequency, uPa^2, for one realisation of the block fading.
struct BlockFading {
  std::array<double, kSignalFrequencies> steady{}, varying{};
  double block_power = 0;  // mean over the band, without the power that fades within a packet

  void scale(double factor);
};

// Realisations of the medium: pressures of its correlation, made from complex normal variables of variance 1
// at each frequency.
inline constexpr std::size_t kMediumStates = 16;
struct MediumNormals {
  using States = std::array<double, kMediumStates>;
  std::array<States, kSignalFrequencies> re{}, im{};
};
std::array<BlockFading, kMediumStates> medium_states(const ReceptionStatistics& sound,
                                                     const MediumNormals& normals);

}  // namespace halocline::acoustics
