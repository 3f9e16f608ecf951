// SPDX-License-Identifier: BSD-3-Clause
// A table of predictions for links with a single path that has not bounced. For a given packet such a link
// depends on the signal-to-noise ratio alone.
//
// The table has steps of kStepDb. Between them a cubic through the four nearest entries is within 5e-4 of
// acoustics/prediction/link_prediction.h, at a tenth of its cost. Where that prediction jumps, the error is
// some hundredths for phase-shift keying of many bits: the interpolated value lies about between the values
// on both sides of the jump. Immutable, so calls may run in parallel. Construction takes a millisecond or
// two.
#pragma once

#include <optional>
#include <vector>

#include "acoustics/fading/arrival.h"
#include "acoustics/fading/path_fading.h"
#include "acoustics/prediction/link_prediction.h"
#include "acoustics/reception/reception_curves.h"

namespace halocline::channel_server {

class OnePathForecast {
 public:
  static constexpr double kMinDb = -30, kMaxDb = 50, kStepDb = 0.2;

  // Builds the table for packets with these curves, over the band of their modem. The table is empty without
  // fading.
  OnePathForecast(const acoustics::FadingModel& fading, const acoustics::ReceptionCurves& curves);

  // Returns the prediction from the table; empty for other paths and for ratios beyond the table. `noise` is
  // in uPa^2 over the band, less the receiver's directivity.
  std::optional<acoustics::LinkPrediction> at(const std::vector<acoustics::Arrival>& paths,
                                              double noise) const;

 private:
  struct Chances {
    double acquisition, delivery;
    double own_share;  // share of the signal that interferes with itself
  };

  acoustics::PathFading of_path_;  // fading of a path that has not bounced
  double noise_factor_ = 1;        // of the receiver that the curves' modem describes
  std::vector<Chances> rows_;
};

}  // namespace halocline::channel_server
