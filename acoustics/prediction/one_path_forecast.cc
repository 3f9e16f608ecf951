// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/prediction/one_path_forecast.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "acoustics/math/fast_functions.h"
#include "acoustics/modem/modem.h"
#include "acoustics/reception/guard_window.h"
#include "core/elementary.h"
#include "core/units.h"

namespace halocline::channel_server {
namespace {

// A path that has not bounced fades by the medium alone, independently of wind and frequency.
acoustics::PathFading fading_without_bounce(const acoustics::FadingModel& fading) {
  return path_fading(fading, /*wind_mps=*/0, /*frequency_hz=*/1000, 0, 0);
}

}  // namespace

OnePathForecast::OnePathForecast(const acoustics::FadingModel& fading,
                                 const acoustics::ReceptionCurves& curves)
    : of_path_(fading_without_bounce(fading)) {
  if (!fading.enabled) return;
  acoustics::Arrival path;
  path.level = Decibels{0};
  path.fading = of_path_;
  const std::vector<acoustics::Arrival> paths{path};
  const acoustics::Modem& modem = curves.modem();
  noise_factor_ = noise_factor(modem);
  const acoustics::GuardWindow window = best_window(paths, modem);
  const int steps = static_cast<int>(std::lround((kMaxDb - kMinDb) / kStepDb));
  for (int i = -1; i <= steps + 1; ++i) {
    const double noise = elementary::exp10(-(kMinDb + i * kStepDb) / 10);
    const acoustics::LinkPrediction one =
        predict_link(fading, paths, {&modem, window}, modem.band(), noise, curves);
    // For a signal of power 1, 1 / SINR = noise factor * noise + own_share.
    rows_.push_back(
        {one.acquisition_probability, one.delivery_probability, 1 / one.sinr - noise_factor_ * noise});
  }
}

std::optional<acoustics::LinkPrediction> OnePathForecast::at(const std::vector<acoustics::Arrival>& paths,
                                                             double noise) const {
  if (rows_.empty() || paths.size() != 1 || !(paths.front().fading == of_path_)) return std::nullopt;
  const double ratio = acoustics::fast_power(paths.front().level.value) / noise;
  const double place = (10 * elementary::log10(ratio) - kMinDb) / kStepDb;
  if (!(place >= 0 && place < static_cast<double>(rows_.size() - 3))) return std::nullopt;
  const auto i = static_cast<std::size_t>(place);  // the ratio lies between rows i + 1 and i + 2
  const double t = place - static_cast<double>(i);
  // Catmull-Rom spline (Catmull and Rom 1974) between b and c, at t in 0..1, with the neighbours a and d:
  //   p(t) = b + t/2 (c - a + t (2 a - 5 b + 4 c - d + t (3 (b - c) + d - a)))
  // Its slopes at b and c are (c - a)/2 and (d - b)/2.
  const auto between = [&](double Chances::*one) {
    const double a = rows_[i].*one, b = rows_[i + 1].*one, c = rows_[i + 2].*one, d = rows_[i + 3].*one;
    return b + t / 2 * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
  };
  // SINR = 1 / (noise / signal + own_share)
  const double over_signal = noise_factor_ / ratio, own_share = between(&Chances::own_share);
  const double delivery = std::clamp(between(&Chances::delivery), 0.0, 1.0);
  return acoustics::LinkPrediction{1 / (over_signal + own_share),
                                   std::clamp(between(&Chances::acquisition), 0.0, 1.0),
                                   delivery,
                                   delivery,
                                   delivery,
                                   {.noise = over_signal, .fast_fading = std::max(own_share, 0.0)}};
}

}  // namespace halocline::channel_server
