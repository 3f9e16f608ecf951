// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/packets/noise_level_cache.h"

namespace halocline::channel_server {

Decibels NoiseLevelCache::level(const acoustics::Band& band, const acoustics::NoiseSources& sources) {
  const Key key{{band.low_hz, band.high_hz, sources.shipping, sources.wind_mps, sources.rain_mm_per_h,
                 sources.offset_db},
                sources.table.get(),
                sources.site.get(),
                sources.place};
  if (key != last_) {
    last_level_ = levels_.find_or_make(
        key, [&] { return acoustics::noise_level_over_band(band.low_hz, band.high_hz, sources); });
    last_ = key;
  }
  return last_level_;
}

}  // namespace halocline::channel_server
