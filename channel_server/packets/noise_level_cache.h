// Noise over the bands in use, each integrated once: a run has few bands and a sea state that changes slowly.
#pragma once

#include <cstddef>
#include <deque>

#include "acoustics/link/capacity.h"
#include "acoustics/sea/noise.h"

namespace halocline::channel_server {

class NoiseLevelCache {
 public:
  static constexpr std::size_t kMaxKept = 32;  // the one noted longest ago makes room

  // dB re 1 uPa; as acoustics::noise_level_over_band.
  Decibels level(const acoustics::Band& band, const acoustics::NoiseSources& sources);

 private:
  struct Entry {
    acoustics::Band band;
    acoustics::NoiseSources sources;
    Decibels level;
  };
  std::deque<Entry> entries_;
};

}  // namespace halocline::channel_server
