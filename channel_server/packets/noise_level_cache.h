// SPDX-License-Identifier: BSD-3-Clause
// A cache of ambient noise levels over the bands in use: each is integrated once, because a run has few bands
// and a sea state that changes slowly.
#pragma once

#include <array>
#include <cstddef>
#include <tuple>

#include "acoustics/link/capacity.h"
#include "acoustics/math/frequency_band.h"
#include "acoustics/noise/noise_spectrum.h"
#include "acoustics/noise/place_noise.h"
#include "acoustics/sea/noise.h"
#include "core/lru_cache.h"
#include "core/units.h"

namespace halocline::channel_server {

class NoiseLevelCache {
 public:
  static constexpr std::size_t kMaxKept = 32;

  // Returns the level over the band, dB re 1 uPa, as acoustics::noise_level_over_band.
  Decibels level(const acoustics::Band& band, const acoustics::NoiseSources& sources);

 private:
  // Low and high end of the band, Hz; shipping; wind, m/s; rain, mm/h; offset, dB; the spectra of the sea and
  // of the place, which outlive the cache and never change; the kind of place.
  using Key = std::tuple<std::array<double, 6>, const acoustics::NoiseSpectrum*,
                         const acoustics::NoiseSpectrum*, acoustics::NoisePlace>;
  LruCache<Key, Decibels> levels_{kMaxKept};
  // The last query and its result: most packets repeat it.
  Key last_ = {};
  Decibels last_level_;
};

}  // namespace halocline::channel_server
