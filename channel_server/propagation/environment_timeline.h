// SPDX-License-Identifier: BSD-3-Clause
// Environment of a run over time: which environment holds at which instant.
//
// A run starts with one environment. Changes follow, from the scenario and from clients that announce them.
// Each change sets some of wind, shipping, sea surface and sound-speed profile from an instant on and leaves
// the rest. A change announced late (its instant lies before what has been published) holds from the instant
// at which it was received, because what is published stays valid. Changes of one instant apply in the order
// of their sessions and sequence numbers. So the environment is a function of what was received and when, not
// of the order of reception within one step.
//
// Where the environment has a field of temperature and salinity that changes with time, sound uses the field
// at the middle of the span of WaterField::period_s that contains the instant. A tide moves the sea surface
// in steps of kTideStepM at most: the level is that of the middle of a step. So many links and packets share
// their searches, and delays jump at the end of a span by what the field changes in it. Spans begin at
// multiples of the period. A sound-speed profile that is announced replaces the field.
//
// A profile that drifts (acoustics/sea/profile_drift.h) is likewise that of the block that contains the
// instant. An announced profile drifts, too.
//
// A value in memory. Not thread-safe, not even its const functions: they cache the environments that a field
// yields.
// makes.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "acoustics/noise/noise_spectrum.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

// Values to set; an empty one stays as it is.
struct EnvironmentChange {
  std::optional<double> wind_mps, shipping, sea_surface_z_m;  // ranges as in acoustics/sea/environment.h
  std::optional<acoustics::SoundSpeedProfile> profile;
  std::optional<double> rain_mm_per_h = {};
  std::shared_ptr<const acoustics::NoiseSpectrum> noise_table = nullptr;
};

class EnvironmentTimeline {
 public:
  static constexpr std::size_t kMaxChanges = 10'000;
  static constexpr std::size_t kAnnouncedKept = 1000;
  static constexpr double kTideStepM = 1e-3;  // rays change by less than a microsecond within half of it

  // Session and sequence number of an announcement; session 0 is the scenario.
  struct Origin {
    std::int64_t session = 0, sequence = 0;
    auto operator<=>(const Origin&) const = default;
  };
  // Number that differs for each environment of a run.
  using WaterId = std::int64_t;

  // Throws InvalidArgument when the environment is out of range.
  explicit EnvironmentTimeline(acoustics::Environment initial);

  // Adds a change of the scenario, which survives clear(). Throws InvalidArgument when a value leaves its
  // range.
  void schedule(SimTime from, const EnvironmentChange& change);
  // Adds a change announced by `origin` to hold from `announced_from`, received at `received_at`. Returns an
  // empty string when it is accepted (a repetition is), else the reason why not.
  [[nodiscard]] std::string announce(SimTime announced_from, SimTime received_at, Origin origin,
                                     const EnvironmentChange& change);

  // Environment at an instant; a change holds at its own instant already. References are valid until the next
  // change is added.
  const acoustics::Environment& at(SimTime instant) const;
  WaterId water_at(SimTime instant) const;
  // Returns the instant of the first change after `instant`, except those of a field or a drift; never() when
  // none is known.
  SimTime next_change_after(SimTime instant) const;

  // Forgets announced changes that were superseded before `time`, except the latest kAnnouncedKept, which may
  // still be repeated. No instant before `time` may be evaluated afterwards.
  void forget_before(SimTime time);
  std::size_t changes_kept() const { return spans_.size() - 1; }

  // Begins another run: forgets announced changes, keeps those of the scenario.
  void clear();

 private:
  struct Order {
    SimTime from;
    Origin origin;
    auto operator<=>(const Order&) const = default;
  };
  struct Span {
    Order order;
    EnvironmentChange change;
    acoustics::Environment environment;  // with all changes up to this one
    WaterId id = 0;
  };
  const Span& span_at(SimTime instant) const;
  // Time for which the water is taken as constant, s; 0 where it does not change by itself. A step of a tide
  // is a power of two of the span of a field or of the block of a drift.
  static double step_s(const acoustics::Environment& environment);
  // Number of the step that contains the instant, counted from time 0; 0 where the water does not change.
  static std::int64_t step_of(const acoustics::Environment& environment, SimTime instant);
  void insert(const Order& order, const EnvironmentChange& change);

  std::vector<Span> spans_;  // ordered; the first is the initial environment
  WaterId last_id_ = 0;
  // Environments of steps of a field, a drift or a tide, and the ends of these steps, s.
  struct StepWater {
    acoustics::Environment environment;
    double end_s = 0;
  };
  mutable std::map<WaterId, StepWater> field_waters_;
};

}  // namespace halocline::channel_server
