// Predictions of links that have one path without a bounce, by a table: there is one for each packet and each ratio of signal to
// noise, as nothing else of the link counts.
//
// Between ratios of kStepDb it is interpolated linearly: within 5e-4 of acoustics/reception/link_prediction.h, at a tenth of its
// cost; where that jumps, by some hundredths for phase-shift keying of many bits, between its values beside the jump. Calls may overlap between threads; the first makes the table, in some milliseconds.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "acoustics/fading/path_fading.h"
#include "acoustics/fading/sound_path.h"
#include "acoustics/reception/link_prediction.h"
#include "acoustics/reception/reception_curves.h"

namespace halocline::channel_server {

class OnePathForecast {
 public:
  static constexpr double kLeastDb = -30, kMostDb = 50, kStepDb = 0.1;

  // Of packets with these curves, over the band of their modem. Nothing, where nothing fades.
  OnePathForecast(const acoustics::FadingModel& fading, acoustics::ReceptionCurves curves);

  // `noise` in uPa^2 over the band, less the receiver's directivity. Empty where the table does not hold: other paths, other
  // ratios.
  std::optional<acoustics::LinkPrediction> at(const std::vector<acoustics::SoundPath>& paths,
                                              double noise) const;

 private:
  struct Chances {
    double acquisition, delivery;
    double own_share;  // of the signal that interferes with itself
  };

  struct Table {
    std::once_flag is_made;
    std::vector<Chances> rows;
  };
  void make_table() const;

  acoustics::FadingModel fading_;
  acoustics::ReceptionCurves curves_;
  acoustics::PathFading of_path_;  // that has not bounced
  std::shared_ptr<Table> table_ = std::make_shared<Table>();
};

}  // namespace halocline::channel_server
