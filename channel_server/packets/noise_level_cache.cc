#include "channel_server/packets/noise_level_cache.h"

namespace halocline::channel_server {

Decibels NoiseLevelCache::level(const acoustics::Band& band, const acoustics::NoiseSources& sources) {
  return levels_.find_or_make({band.low_hz, band.high_hz, sources.shipping, sources.wind_mps}, [&] {
    return acoustics::noise_level_over_band(band.low_hz, band.high_hz, sources);
  });
}

}  // namespace halocline::channel_server
