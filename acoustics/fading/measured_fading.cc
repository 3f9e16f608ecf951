// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/fading/measured_fading.h"

#include <cmath>
#include <cstdint>
#include <utility>

#include "acoustics/rays/eigenray.h"
#include "core/check.h"
#include "core/random.h"

namespace halocline::acoustics {

std::vector<Arrival> measured_paths(const MeasuredChannel& channel, const Arrival& reference,
                                    Decibels level) {
  std::vector<Arrival> paths;
  for (const MeasuredTap& tap : channel.taps()) {
    Arrival path = reference;
    path.delay_s += tap.delay_s;
    path.level = level + to_decibels(PowerRatio{tap.power / channel.power()});
    path.phase_rad = tap.phase_rad;
    path.identity = PathIdentity::of_number(paths.size());
    path.fading = {tap.coherent, 0, 1 - tap.coherent, tap.doppler_spread_hz};
    paths.push_back(path);
  }
  return paths;
}

MeasuredFading::MeasuredFading(std::shared_ptr<const MeasuredChannel> channel, const FadingLink& link)
    : channel_(std::move(channel)) {
  const DrawAddress address{.seed = link.seed,
                            .purpose = purpose_of("measured-channel-offset"),
                            .who = link.lower_id,
                            .which = link.higher_id};
  offset_s_ = uniform_at(address) * channel_->duration_s();
}

std::vector<std::complex<double>> MeasuredFading::responses(const std::vector<Arrival>& paths, const Band&,
                                                            SimTime start, const FadingTimes& times,
                                                            double large_scale) const {
  const std::vector<MeasuredTap>& taps = channel_->taps();
  ensure(paths.size() == taps.size(), "paths that are not the taps of their measured channel");
  const auto count = static_cast<std::size_t>(times.count);
  auto all = channel_->values(start.seconds() + times.begin_s + offset_s_, times.step_s, count);
  for (std::size_t p = 0; p < paths.size(); ++p) {
    const double scale = large_scale * std::sqrt(to_power_ratio(paths[p].level).value / taps[p].power);
    for (std::size_t i = 0; i < count; ++i) all[p * count + i] *= scale;
  }
  return all;
}

}  // namespace halocline::acoustics
