#include "channel_server/links/one_path_forecast.h"

#include <cmath>
#include <cstddef>
#include <utility>

#include "acoustics/math/fast_functions.h"
#include "acoustics/modem/modem.h"
#include "acoustics/reception/guard_window.h"
#include "core/elementary.h"
#include "core/units.h"

namespace halocline::channel_server {
namespace {

// A path that has not bounced fades by the medium alone, whatever wind and frequency.
acoustics::PathFading fading_without_bounce(const acoustics::FadingModel& fading) {
  return path_fading(fading, /*wind_mps=*/0, /*frequency_hz=*/1000, 0, 0);
}

bool is_same(const acoustics::PathFading& a, const acoustics::PathFading& b) {
  return a.coherent == b.coherent && a.medium == b.medium && a.scattered == b.scattered &&
         a.doppler_spread_hz == b.doppler_spread_hz;
}

}  // namespace

OnePathForecast::OnePathForecast(const acoustics::FadingModel& fading, acoustics::ReceptionCurves curves)
    : fading_(fading), curves_(std::move(curves)), of_path_(fading_without_bounce(fading)) {}

void OnePathForecast::make_table() const {
  acoustics::SoundPath path;
  path.level = Decibels{0};
  path.fading = of_path_;
  const std::vector<acoustics::SoundPath> paths{path};
  const acoustics::Modem& modem = curves_.modem();
  const acoustics::GuardWindow window = best_window(paths, modem);
  const int steps = static_cast<int>(std::lround((kMostDb - kLeastDb) / kStepDb));
  for (int i = 0; i <= steps; ++i) {
    const double noise = elementary::exp10(-(kLeastDb + i * kStepDb) / 10);
    const acoustics::LinkPrediction one =
        predict_link(fading_, paths, {&modem, window}, modem.band(), noise, curves_);
    table_->rows.push_back({one.acquisition_probability, one.delivery_probability, 1 / one.sinr - noise});
  }
}

std::optional<acoustics::LinkPrediction> OnePathForecast::at(const std::vector<acoustics::SoundPath>& paths,
                                                             double noise) const {
  if (!fading_.enabled || paths.size() != 1 || !is_same(paths.front().fading, of_path_)) return std::nullopt;
  const double ratio = acoustics::fast_power(paths.front().level.value) / noise;
  const double place = (10 * elementary::log10(ratio) - kLeastDb) / kStepDb;
  if (!(place >= 0 && kLeastDb + place * kStepDb < kMostDb)) return std::nullopt;
  std::call_once(table_->is_made, [this] { make_table(); });
  const auto i = static_cast<std::size_t>(place);
  const double part = place - static_cast<double>(i);
  const Chances &low = table_->rows[i], &high = table_->rows[i + 1];
  const auto between = [&](double Chances::*one) { return low.*one + part * (high.*one - low.*one); };
  return acoustics::LinkPrediction{1 / (1 / ratio + between(&Chances::own_share)),
                                   between(&Chances::acquisition), between(&Chances::delivery)};
}

}  // namespace halocline::channel_server
