#include "channel_server/packets/noise_level_cache.h"

#include <algorithm>
#include <tuple>

namespace halocline::channel_server {

Decibels NoiseLevelCache::level(const acoustics::Band& band, const acoustics::NoiseSources& sources) {
  const auto key = [](const acoustics::Band& b, const acoustics::NoiseSources& s) {
    return std::tuple(b.low_hz, b.high_hz, s.shipping, s.wind_mps);
  };
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return key(entry.band, entry.sources) == key(band, sources);
  });
  if (found != entries_.end()) return found->level;
  if (entries_.size() >= kMaxKept) entries_.pop_front();
  const Decibels level = acoustics::noise_level_over_band(band.low_hz, band.high_hz, sources);
  entries_.push_back({band, sources, level});
  return level;
}

}  // namespace halocline::channel_server
