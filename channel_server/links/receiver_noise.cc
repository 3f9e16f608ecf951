// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/links/receiver_noise.h"

#include <set>

#include "acoustics/math/frequency_band.h"
#include "acoustics/modem/modem.h"
#include "core/frames.h"

namespace halocline::channel_server {

NoiseOfLinks::Key NoiseOfLinks::key_of(const EndPair& link) {
  const Vec3& place = link.to.position_ned_m;
  const acoustics::Band band = link.from.modem->band();
  return {link.to.id, {place.x(), place.y(), place.z(), band.low_hz, band.high_hz}};
}

bool NoiseOfLinks::are_ready(const std::vector<EndPair>& links) {
  if (!model_.may_wait()) return true;
  bool ready = true;
  std::set<Key> asked;
  for (const EndPair& link : links) {
    if (asked.insert(key_of(link)).second) ready = model_.is_ready(link, at_, silent_) && ready;
  }
  return ready;
}

void NoiseOfLinks::set(EndPair& link) {
  if (!model_.differ()) return;
  const auto [found, is_new] = found_.try_emplace(key_of(link));
  if (is_new) found->second = model_.above_ambient(link, at_, silent_);
  link.to.above_ambient = found->second;
}

}  // namespace halocline::channel_server
