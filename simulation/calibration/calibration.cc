// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/calibration/calibration.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/check.h"
#include "core/elementary.h"
#include "simulation/ensemble/key_changes.h"
#include "simulation/link_survey.h"
#include "simulation/uncertainty_config.h"

namespace halocline::clients {
namespace {

constexpr double kOffsetDb = 6, kHighOffsetDb = 10, kReceiverSpreadDb = 2;  // deviations of priors
constexpr double kSlowDb = 4.2, kLnSlowSpread = 0.5;
constexpr double kToldBelow = 0.8;  // of the prior's deviation
constexpr double kCorrelatedFrom = 0.9;
constexpr std::size_t kLeastPairs = 3;  // for more than the offset
constexpr std::int64_t kLeastFacts = 30;
constexpr double kJoinedS = 43'200;  // span over which bins share the slow sea

// What a trial measured.
struct TrialFacts {
  std::int64_t packets = 0, levels = 0, snrs = 0;
  std::size_t bins = 0;
};

TrialFacts facts_of(const std::vector<ForecastPair>& pairs) {
  TrialFacts facts;
  for (const ForecastPair& pair : pairs) {
    facts.bins += pair.trial.bins.size();
    for (const TrialBin& bin : pair.trial.bins) {
      facts.packets += bin.sent;
      facts.levels += static_cast<std::int64_t>(bin.levels);
      facts.snrs += static_cast<std::int64_t>(bin.snrs);
    }
  }
  return facts;
}

SeaPriors priors_of(double frequency_hz, bool is_split) {
  const double offset_db = frequency_hz > Uncertainty::kHighHz ? kHighOffsetDb : kOffsetDb;
  const double noise_db =
      is_split ? std::sqrt(offset_db * offset_db - kReceiverSpreadDb * kReceiverSpreadDb) : offset_db;
  SeaPriors priors;
  priors[kNoiseDb] = {0, noise_db};
  priors[kReceiverDb] = {0, kReceiverSpreadDb};
  priors[kLnBottom] = {0, std::numbers::ln2};
  priors[kLnSlowDb] = {elementary::log(kSlowDb), kLnSlowSpread};
  priors[kLnEcho] = {0, std::numbers::ln2};
  return priors;
}

std::string name_of(SeaNumber number, bool is_split) {
  switch (number) {
    case kNoiseDb:
      return is_split ? "offset_db of noise" : "offset_db";
    case kReceiverDb:
      return "offset_db of receivers";
    case kLnBottom:
      return "boundary_scale";
    case kLnSlowDb:
      return "slow_db";
    case kLnEcho:
    case kSeaNumbers:
      break;
  }
  return "echo_scale";
}

CalibratedNumber calibrated(SeaNumber number, bool is_split, const SeaPrior& prior, const SeaPosterior& first,
                            const SeaPosterior& last) {
  CalibratedNumber made{.name = name_of(number, is_split), .number = number};
  made.is_logarithmic = number == kLnBottom || number == kLnSlowDb || number == kLnEcho;
  const auto value = [&](double x) { return made.is_logarithmic ? elementary::exp(x) : x; };
  made.prior_value = value(prior.mean);
  made.prior_deviation = prior.deviation;
  made.fitted_deviation = first.deviation(first.index_of(number));
  const std::size_t index = last.index_of(number);
  made.is_told = index < last.fitted.size();
  made.value = value(last.numbers[number]);
  made.deviation = made.is_told ? last.deviation(index) : prior.deviation;
  return made;
}

std::vector<CorrelatedNumbers> correlated_of(const SeaPosterior& first, bool is_split) {
  std::vector<CorrelatedNumbers> found;
  for (std::size_t i = 0; i < first.fitted.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const double correlation = first.correlation(k, i);
      if (std::abs(correlation) > kCorrelatedFrom)
        found.push_back(
            {name_of(first.fitted[k], is_split), name_of(first.fitted[i], is_split), correlation});
    }
  }
  return found;
}

// Numbers that this trial may tell.
std::vector<SeaNumber> candidates_of(const TrialFacts& facts, bool is_split, bool is_few, bool has_bottom,
                                     bool has_echoes) {
  std::vector<SeaNumber> candidates;
  if (facts.packets > 0 || facts.snrs > 0) candidates.push_back(kNoiseDb);
  if (is_few) return candidates;
  if (is_split) candidates.push_back(kReceiverDb);
  if (has_bottom) candidates.push_back(kLnBottom);
  candidates.push_back(kLnSlowDb);
  if (has_echoes && facts.packets > 0) candidates.push_back(kLnEcho);
  return candidates;
}

// Numbers that vary between seas, but are held by the fit.
std::vector<SeaNumber> unknown_of(const SeaPosterior& last, bool has_bottom, bool has_echoes) {
  std::vector<SeaNumber> unknown;
  const auto add = [&](SeaNumber number, bool exists) {
    if (exists && last.index_of(number) == last.fitted.size()) unknown.push_back(number);
  };
  add(kNoiseDb, true);
  add(kLnBottom, has_bottom);
  add(kLnSlowDb, true);
  add(kLnEcho, has_echoes);
  return unknown;
}

SlowTimes slow_times(const ScenarioConfig& config) {
  SlowTimes times;
  const auto set = [&](const char* key, double& value) {
    value = std::max(number_of_key(config.channel_server, key).value_or(value), 1.0);
  };
  set("propagation.slow_fading_s", times.fading_s);
  set("environment.noise_spread_s", times.noise_s);
  times.bin_s = times.fading_s / 3;
  return times;
}

}  // namespace

const CalibratedNumber* Calibration::told(SeaNumber number) const {
  const auto found = std::find_if(numbers.begin(), numbers.end(), [&](const CalibratedNumber& one) {
    return one.number == number && one.is_told;
  });
  return found == numbers.end() ? nullptr : &*found;
}

Calibration calibrate_forecasts(const std::vector<ForecastPair>& pairs, double frequency_hz, bool has_bottom,
                                bool has_echoes) {
  require(!pairs.empty(), "a calibration needs a pair");
  const SlowTimes& times = pairs.front().times;
  const TrialFacts facts = facts_of(pairs);
  Calibration result;
  result.pairs = pairs.size();
  result.bins = facts.bins;
  result.packets = facts.packets;
  result.levels = facts.levels + facts.snrs;
  result.times = times;
  result.is_offset_alone = pairs.size() < kLeastPairs || facts.packets + result.levels < kLeastFacts;
  const bool is_split = !result.is_offset_alone && facts.packets > 0 && facts.snrs > 0;
  const TrialFit fit(pairs, priors_of(frequency_hz, is_split),
                     static_cast<int>(std::lround(kJoinedS / times.bin_s)));
  const SeaPosterior first =
      fit.fit(candidates_of(facts, is_split, result.is_offset_alone, has_bottom, has_echoes));
  std::vector<SeaNumber> told;
  for (std::size_t i = 0; i < first.fitted.size(); ++i)
    if (first.deviation(i) <= kToldBelow * fit.priors()[first.fitted[i]].deviation)
      told.push_back(first.fitted[i]);
  const SeaPosterior last = told == first.fitted ? first : fit.fit(told);
  for (const SeaNumber number : first.fitted)
    result.numbers.push_back(calibrated(number, is_split, fit.priors()[number], first, last));
  result.correlated = correlated_of(first, is_split);
  const std::size_t noise = last.index_of(kNoiseDb), bottom = last.index_of(kLnBottom);
  if (std::max(noise, bottom) < last.fitted.size())
    result.noise_bottom_correlation = last.correlation(noise, bottom);
  if (pairs.size() > 1)
    result.checks = check_left_out(fit, last, unknown_of(last, has_bottom, has_echoes), pairs);
  return result;
}

Calibration calibrate(const ScenarioConfig& config, const std::vector<TrialRow>& rows) {
  require(!rows.empty(), "a calibration needs measurements: there are none");
  const SlowTimes times = slow_times(config);
  const std::vector<TrialPair> trials = pairs_of(rows, times.bin_s);
  const std::vector<double> changes = changes_of_sea(config);
  const auto sea_of = [&](const TrialBin& bin) {
    const auto after = std::upper_bound(changes.begin(), changes.end(), bin.first_time_s);
    return static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - changes.begin() - 1, 0));
  };
  std::vector<std::vector<std::size_t>> wanted;
  for (const TrialPair& trial : trials) {
    std::vector<std::size_t>& seas = wanted.emplace_back();
    for (const TrialBin& bin : trial.bins) seas.push_back(sea_of(bin));
    std::sort(seas.begin(), seas.end());
    seas.erase(std::unique(seas.begin(), seas.end()), seas.end());
  }
  auto forecasts = pair_forecasts(config, trials, changes, wanted);
  std::vector<ForecastPair> pairs;
  for (std::size_t p = 0; p < trials.size(); ++p) {
    ForecastPair pair{trials[p], std::move(forecasts[p]), {}, times};
    for (const TrialBin& bin : trials[p].bins)
      pair.forecast_of.push_back(static_cast<std::size_t>(
          std::lower_bound(wanted[p].begin(), wanted[p].end(), sea_of(bin)) - wanted[p].begin()));
    pairs.push_back(std::move(pair));
  }
  const double frequency_hz = link_end(config, trials.front().from).modem.modem.centre_frequency_hz;
  return calibrate_forecasts(pairs, frequency_hz, has_bottom_factor(config), has_echo_factor(config));
}

}  // namespace halocline::clients
