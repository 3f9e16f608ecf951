// SPDX-License-Identifier: BSD-3-Clause
// A measured channel in the place of a link's fading paths.
//
// A link is somewhere else in the record than others: its own time 0 is drawn from (seed, pair of ends), and
// both directions have the same. So a value is a function of (seed, pair, absolute time of arrival), like
// acoustics/fading/link_fading.h. The channel's taps become paths: the first of them arrives when the
// reference, a path of the modelled sea, does, with its angles and Doppler shift; powers are those of the
// record, scaled to a level in all. Large-scale fading remains the model's, since a record of a minute holds
// none. For predictions a tap is its steady mean and otherwise scattered. Left out: that the measured channel
// belongs to another place than that of the link's ends.
#pragma once

#include <complex>
#include <memory>
#include <vector>

#include "acoustics/fading/link_fading.h"
#include "acoustics/fading/measured_channel.h"
#include "acoustics/fading/path_responses.h"
#include "acoustics/fading/sound_path.h"
#include "acoustics/math/frequency_band.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::acoustics {

// One path a tap, by delay; their powers sum to `level`.
std::vector<SoundPath> measured_paths(const MeasuredChannel& channel, const SoundPath& reference,
                                      Decibels level);

class MeasuredFading : public PathResponses {
 public:
  MeasuredFading(std::shared_ptr<const MeasuredChannel> channel, const FadingLink& link);

  // Where in the record the link is at time 0, s, from 0 to its duration.
  double offset_s() const { return offset_s_; }

  // `paths` are all of measured_paths(), at any level.
  std::vector<std::complex<double>> responses(const std::vector<SoundPath>& paths, const Band& band,
                                              SimTime start, const FadingTimes& times,
                                              double large_scale) const override;

 private:
  std::shared_ptr<const MeasuredChannel> channel_;
  double offset_s_;
};

}  // namespace halocline::acoustics
