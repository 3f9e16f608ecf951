// SPDX-License-Identifier: BSD-3-Clause
// Replaces a link's modelled fading paths by a measured channel.
//
// Each link starts at another time in the record: its offset is drawn from (seed, pair of ends), and both
// directions of a link share it. A value is therefore a function of (seed, pair, absolute time of arrival),
// as in acoustics/fading/link_fading.h. The taps of the channel become paths. The first tap arrives when the
// reference does, a path of the modelled sea, and all taps have the reference's angles and Doppler shift.
// Powers are those of the record, scaled to a given total level. Large-scale fading comes from the model,
// because a record of a minute contains none. For predictions, the steady mean of a tap is its coherent share
// and the rest is scattered. Neglected: the measured channel belongs to another place than the ends of the
// link.
#pragma once

#include <complex>
#include <memory>
#include <vector>

#include "acoustics/fading/arrival.h"
#include "acoustics/fading/link_fading.h"
#include "acoustics/fading/measured_channel.h"
#include "acoustics/fading/path_responses.h"
#include "acoustics/math/frequency_band.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::acoustics {

// One path per tap, by delay; their powers sum to `level`.
std::vector<Arrival> measured_paths(const MeasuredChannel& channel, const Arrival& reference, Decibels level);

class MeasuredFading : public PathResponses {
 public:
  MeasuredFading(std::shared_ptr<const MeasuredChannel> channel, const FadingLink& link);

  // The time in the record at which the link starts, s, from 0 to the record's duration.
  double offset_s() const { return offset_s_; }

  // Responses of the paths. `paths` are all paths of measured_paths(), at any level.
  std::vector<std::complex<double>> responses(const std::vector<Arrival>& paths, const Band& band,
                                              SimTime start, const FadingTimes& times,
                                              double large_scale) const override;

 private:
  std::shared_ptr<const MeasuredChannel> channel_;
  double offset_s_;
};

}  // namespace halocline::acoustics
