// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/calibration/trial_forecast.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "acoustics/link/link_budget.h"
#include "bathymetry/terrain/terrain.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/water_model.h"
#include "core/elementary.h"
#include "simulation/ensemble/key_changes.h"
#include "simulation/ensemble/sea_member.h"
#include "simulation/link_survey.h"
#include "simulation/link_surveyor.h"

namespace halocline::clients {
namespace {

constexpr std::size_t kMiddle = kLnFactors.size() / 2;
const std::string kEchoKey = "calibration.echo_factor";

// Weights of the factors at ln_factor by Catmull and Rom's cubic, whose slope has no steps. Beyond the ends
// of the table, and for a factor that the cubic lacks there, the line through the last two holds, so that a
// likelihood has a curvature there, too.
PairForecast::Values weights_at(double ln_factor) {
  constexpr std::size_t kLast = kLnFactors.size() - 1;
  const double place = (ln_factor - kLnFactors[0]) / (kLnFactors[1] - kLnFactors[0]);
  const auto i = static_cast<std::size_t>(std::clamp(std::floor(place), 0.0, static_cast<double>(kLast - 1)));
  const double t = place - static_cast<double>(i), u = 1 - t;
  PairForecast::Values weights{};
  if (t < 0 || t > 1) {
    weights[i] = u;
    weights[i + 1] = t;
    return weights;
  }
  const double before = -0.5 * t * u * u, after = -0.5 * t * t * u;
  weights[i] = 1 - t * t * (2.5 - 1.5 * t);
  weights[i + 1] = t * (0.5 + t * (2 - 1.5 * t));
  if (i > 0) {
    weights[i - 1] += before;
  } else {
    weights[0] += 2 * before;
    weights[1] -= before;
  }
  if (i + 2 <= kLast) {
    weights[i + 2] += after;
  } else {
    weights[i + 1] += 2 * after;
    weights[i] -= after;
  }
  return weights;
}

void scale_echoes(channel_server::ChannelServerConfig& config, double factor) {
  change_keys(config, {scaled(kEchoKey, factor)});
}

// Returns the scenario as it is from a time on, without changes to come.
ScenarioConfig sea_from(const ScenarioConfig& config, double time_s) {
  ScenarioConfig sea = config;
  channel_server::EnvironmentConfig& water = sea.channel_server.environment;
  std::vector<channel_server::ChangeConfig> changes = config.channel_server.changes;
  std::stable_sort(changes.begin(), changes.end(),
                   [](const auto& a, const auto& b) { return a.at_s < b.at_s; });
  for (const channel_server::ChangeConfig& change : changes) {
    if (change.at_s > time_s) break;
    if (change.wind_mps) water.noise.wind_mps = *change.wind_mps;
    if (change.shipping) water.noise.shipping = *change.shipping;
    if (change.rain_mm_per_h) water.noise.rain_mm_per_h = *change.rain_mm_per_h;
    if (change.profile) water.profile = *change.profile;
    if (change.sea_surface_z_m) sea.scenario.sea_surface_z_m = *change.sea_surface_z_m;
  }
  sea.channel_server.changes.clear();
  return sea;
}

using TerrainPointer = std::shared_ptr<const bathymetry::Terrain>;

// Forecaster of pairs in one sea: at one factor of the bottom, and at the middle one also of echoes.
class SeaForecaster {
 public:
  SeaForecaster(const ScenarioConfig& config, TerrainPointer terrain, std::size_t factor)
      : config_(config),
        terrain_(std::move(terrain)),
        factor_(factor),
        surveyor_(config, terrain_, read_water(config.channel_server, config.scenario)) {}

  void add(const TrialPair& pair, PairForecast& forecast) {
    const LinkSurveyEnd from = link_end(config_, pair.from), to = link_end(config_, pair.to);
    require_above_seabed(*terrain_, from);
    require_above_seabed(*terrain_, to);
    const channel_server::EndPair link = ends_between(from, to);
    const channel_server::Reception reception = surveyor_.survey(link.from, link.to).reception;
    forecast.level_db[factor_] = reception.budget.received_level.value;
    forecast.snr_db[factor_] = reception.budget.snr.value;
    forecast.by_bottom[factor_] = curve(link, reception);
    if (factor_ == kMiddle) add_echoes(pair, reception, forecast);
  }

 private:
  DeliveryCurve::Scores curve(const channel_server::EndPair& link,
                              const channel_server::Reception& reception) {
    return DeliveryCurve([&](double more_noise_db) {
             return surveyor_.forecast_in_noise(link.from, link.to, reception, more_noise_db)
                 .delivery_probability;
           })
        .scores();
  }

  // The echoes' share acts in the receiver, so the reception stays.
  void add_echoes(const TrialPair& pair, const channel_server::Reception& reception, PairForecast& forecast) {
    forecast.by_echo.fill(forecast.by_bottom[kMiddle]);
    if (!has_echo_factor(config_)) return;
    for (std::size_t k = 0; k < kLnFactors.size(); ++k) {
      if (k == kMiddle) continue;
      ScenarioConfig echoes = config_;
      scale_echoes(echoes.channel_server, elementary::exp(kLnFactors[k]));
      const LinkSurveyEnd from = link_end(echoes, pair.from), to = link_end(echoes, pair.to);
      forecast.by_echo[k] = curve(ends_between(from, to), reception);
    }
  }

  const ScenarioConfig& config_;
  TerrainPointer terrain_;
  std::size_t factor_;
  LinkSurveyor surveyor_;
};

}  // namespace

double PairForecast::at(const Values& values, double ln_factor) {
  const Values weights = weights_at(ln_factor);
  double sum = 0;
  for (std::size_t k = 0; k < values.size(); ++k) sum += weights[k] * values[k];
  return sum;
}

DeliveryCurve::Scores PairForecast::scores_at(double ln_bottom, double ln_echo) const {
  const Values bottom = weights_at(ln_bottom), echo = weights_at(ln_echo);
  DeliveryCurve::Scores scores;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    double sum = -by_echo[kMiddle][i];
    for (std::size_t k = 0; k < bottom.size(); ++k)
      sum += bottom[k] * by_bottom[k][i] + echo[k] * by_echo[k][i];
    scores[i] = sum;
  }
  return scores;
}

bool has_bottom_factor(const ScenarioConfig& config) {
  return config.channel_server.propagation.model == channel_server::PropagationModel::kRays &&
         config.channel_server.propagation.fading.enabled;
}

bool has_echo_factor(const ScenarioConfig& config) {
  const channel_server::ConfiguredModems modems = make_modems(config.channel_server);
  return modems.standard.modem.late_echo_share > 0 ||
         std::any_of(modems.of_vehicle.begin(), modems.of_vehicle.end(),
                     [](const auto& own) { return own.second.modem.late_echo_share > 0; });
}

std::vector<double> changes_of_sea(const ScenarioConfig& config) {
  std::vector<double> from_s{0};
  for (const channel_server::ChangeConfig& change : config.channel_server.changes)
    if (change.at_s > 0) from_s.push_back(change.at_s);
  std::sort(from_s.begin(), from_s.end());
  from_s.erase(std::unique(from_s.begin(), from_s.end()), from_s.end());
  return from_s;
}

std::vector<std::vector<PairForecast>> pair_forecasts(const ScenarioConfig& config,
                                                      const std::vector<TrialPair>& pairs,
                                                      const std::vector<double>& from_s,
                                                      const std::vector<std::vector<std::size_t>>& wanted) {
  const TerrainPointer terrain = make_terrain(config).terrain;
  std::vector<std::vector<PairForecast>> forecasts(pairs.size());
  for (std::size_t p = 0; p < pairs.size(); ++p) forecasts[p].resize(wanted[p].size());
  for (std::size_t time = 0; time < from_s.size(); ++time) {
    ScenarioConfig sea = sea_from(config, from_s[time]);
    still_the_hours(sea.channel_server);
    for (std::size_t factor = 0; factor < kLnFactors.size(); ++factor) {
      ScenarioConfig scaled_sea = sea;
      scale_bottom(scaled_sea.channel_server, elementary::exp(kLnFactors[factor]));
      std::unique_ptr<SeaForecaster> forecaster;  // made for the first pair that needs it
      for (std::size_t p = 0; p < pairs.size(); ++p) {
        const auto found = std::lower_bound(wanted[p].begin(), wanted[p].end(), time);
        if (found == wanted[p].end() || *found != time) continue;
        if (!forecaster) forecaster = std::make_unique<SeaForecaster>(scaled_sea, terrain, factor);
        forecaster->add(pairs[p], forecasts[p][static_cast<std::size_t>(found - wanted[p].begin())]);
      }
    }
  }
  return forecasts;
}

}  // namespace halocline::clients
