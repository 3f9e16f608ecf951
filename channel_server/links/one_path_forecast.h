// SPDX-License-Identifier: BSD-3-Clause
// Predictions of links that have one path without a bounce, by a table: there is one for each packet and each
// ratio of signal to noise, as nothing else of the link counts.
//
// Between ratios of kStepDb a cubic goes through the four nearest: within 5e-4 of
// acoustics/reception/link_prediction.h, at a tenth of its cost; where that jumps, by some hundredths for
// phase-shift keying of many bits, about between its values beside the jump. Immutable: calls may overlap
// between threads. Making one takes a millisecond or two.
#pragma once

#include <optional>
#include <vector>

#include "acoustics/fading/path_fading.h"
#include "acoustics/fading/sound_path.h"
#include "acoustics/reception/link_prediction.h"
#include "acoustics/reception/reception_curves.h"

namespace halocline::channel_server {

class OnePathForecast {
 public:
  static constexpr double kLeastDb = -30, kMostDb = 50, kStepDb = 0.2;

  // Of packets with these curves, over the band of their modem. Empty, without a table, where nothing fades.
  OnePathForecast(const acoustics::FadingModel& fading, const acoustics::ReceptionCurves& curves);

  // `noise` in uPa^2 over the band, less the receiver's directivity. Empty where the table does not hold:
  // other paths, other ratios.
  std::optional<acoustics::LinkPrediction> at(const std::vector<acoustics::SoundPath>& paths,
                                              double noise) const;

 private:
  struct Chances {
    double acquisition, delivery;
    double own_share;  // of the signal that interferes with itself
  };

  acoustics::PathFading of_path_;  // that has not bounced
  std::vector<Chances> rows_;
};

}  // namespace halocline::channel_server
