// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/environment_timeline.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "acoustics/sea/profile_drift.h"
#include "core/check.h"

namespace halocline::channel_server {
namespace {

acoustics::Environment changed(acoustics::Environment environment, const EnvironmentChange& change) {
  const double wind_mps = change.wind_mps.value_or(environment.noise.wind_mps);
  environment.noise.wind_mps = environment.ice.covers() ? 0 : wind_mps;
  environment.noise.shipping = change.shipping.value_or(environment.noise.shipping);
  environment.sea_surface_z_m = change.sea_surface_z_m.value_or(environment.sea_surface_z_m);
  environment.noise.rain_mm_per_h = change.rain_mm_per_h.value_or(environment.noise.rain_mm_per_h);
  if (change.noise_table) environment.noise.table = change.noise_table;
  if (change.profile) {
    environment.profile = *change.profile;
    environment.field = {};
  }
  return environment;
}

constexpr EnvironmentTimeline::WaterId kIdsOfAStep = 1LL << 32;  // more than the ids of all other changes

bool changes_by_itself(const acoustics::Environment& environment) {
  return environment.drift.any() || (environment.field && !environment.field.ocean->is_steady());
}

double period_of(const acoustics::Environment& environment) {
  return environment.field ? environment.field.period_s : acoustics::ProfileDrift::kBlockS;
}

constexpr SimTime kAlways = SimTime::from_nanoseconds(std::numeric_limits<std::int64_t>::min());

}  // namespace

EnvironmentTimeline::EnvironmentTimeline(acoustics::Environment initial) {
  validate(initial);
  spans_.push_back({{kAlways, {}}, {}, std::move(initial), ++last_id_});
}

void EnvironmentTimeline::schedule(SimTime from, const EnvironmentChange& change) {
  validate(changed(at(from), change));
  insert({from, {0, static_cast<std::int64_t>(spans_.size())}}, change);
}

std::string EnvironmentTimeline::announce(SimTime announced_from, SimTime received_at, Origin origin,
                                          const EnvironmentChange& change) {
  const bool is_repetition = std::any_of(spans_.begin(), spans_.end(),
                                         [&](const Span& span) { return span.order.origin == origin; });
  if (is_repetition) return {};
  if (spans_.size() > kMaxChanges) return "too many changes of the environment in one run";
  const SimTime from = std::max(announced_from, received_at);
  try {
    validate(changed(at(from), change));
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  insert({from, origin}, change);
  return {};
}

void EnvironmentTimeline::insert(const Order& order, const EnvironmentChange& change) {
  const auto later = std::upper_bound(spans_.begin() + 1, spans_.end(), order,
                                      [](const Order& one, const Span& span) { return one < span.order; });
  auto span = spans_.insert(later, Span{order, change, std::prev(later)->environment, 0});
  for (; span != spans_.end(); ++span) {
    span->environment = changed(std::prev(span)->environment, span->change);
    span->id = ++last_id_;
  }
}

const EnvironmentTimeline::Span& EnvironmentTimeline::span_at(SimTime instant) const {
  const auto later = std::upper_bound(spans_.begin() + 1, spans_.end(), instant,
                                      [](SimTime time, const Span& span) { return time < span.order.from; });
  return *std::prev(later);
}

double EnvironmentTimeline::step_s(const acoustics::Environment& environment) {
  const double rate_mps = environment.tide.max_rate_mps();
  if (!(rate_mps > 0)) return changes_by_itself(environment) ? period_of(environment) : 0;
  constexpr double kMinStepS = 0.5;
  double step = period_of(environment);
  while (step > kMinStepS && step * rate_mps > kTideStepM) step /= 2;
  return step;
}

std::int64_t EnvironmentTimeline::step_of(const acoustics::Environment& environment, SimTime instant) {
  const double step = step_s(environment);
  return step > 0 ? static_cast<std::int64_t>(std::floor(instant.seconds() / step)) : 0;
}

EnvironmentTimeline::WaterId EnvironmentTimeline::water_at(SimTime instant) const {
  const Span& span = span_at(instant);
  return span.id + step_of(span.environment, instant) * kIdsOfAStep;
}

const acoustics::Environment& EnvironmentTimeline::at(SimTime instant) const {
  const Span& span = span_at(instant);
  const double length_s = step_s(span.environment);
  if (!(length_s > 0)) return span.environment;
  const std::int64_t step = step_of(span.environment, instant);
  const auto [known, is_new] =
      field_waters_.try_emplace(span.id + step * kIdsOfAStep, StepWater{span.environment});
  acoustics::Environment& there = known->second.environment;
  if (!is_new) return there;
  known->second.end_s = static_cast<double>(step + 1) * length_s;
  const double middle_s = (static_cast<double>(step) + 0.5) * length_s;
  there.sea_surface_z_m -= there.tide.height_m(middle_s);
  if (!changes_by_itself(there)) return there;
  const double period_s = period_of(there), block = std::floor(middle_s / period_s);
  there.field.time_s = (block + 0.5) * period_s;
  if (there.field) there.profile = environment_at(there, 0, 0).profile;
  if (there.drift.any()) {
    const auto amplitudes = drift_amplitudes(there.drift, static_cast<std::int64_t>(block));
    there.profile = there.profile.with_change(drift_rows(there.drift.depth_m, amplitudes));
  }
  return there;
}

SimTime EnvironmentTimeline::next_change_after(SimTime instant) const {
  const auto later = std::upper_bound(spans_.begin() + 1, spans_.end(), instant,
                                      [](SimTime time, const Span& span) { return time < span.order.from; });
  return later == spans_.end() ? SimTime::never() : later->order.from;
}

void EnvironmentTimeline::forget_before(SimTime time) {
  std::erase_if(field_waters_, [time](const auto& water) {
    return water.second.end_s + period_of(water.second.environment) / 2 < time.seconds();
  });
  constexpr std::size_t kForgottenTogether = kAnnouncedKept / 10;  // each removal moves all other spans
  if (changes_kept() < kAnnouncedKept + kForgottenTogether) return;
  auto surplus = changes_kept() - kAnnouncedKept;
  std::vector<Span> kept;
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    const bool announced = i > 0 && spans_[i].order.origin.session != 0;
    const bool superseded = i + 1 < spans_.size() && spans_[i + 1].order.from <= time;
    if (surplus > 0 && announced && superseded) {
      --surplus;
    } else {
      kept.push_back(std::move(spans_[i]));
    }
  }
  spans_ = std::move(kept);
}

void EnvironmentTimeline::clear() {
  std::vector<Span> scheduled;
  for (const Span& span : spans_) {
    if (span.order.origin.session == 0) scheduled.push_back(span);
  }
  spans_.assign(1, scheduled.front());
  for (auto span = scheduled.begin() + 1; span != scheduled.end(); ++span) insert(span->order, span->change);
}

}  // namespace halocline::channel_server
