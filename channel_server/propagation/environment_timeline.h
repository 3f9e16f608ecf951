// SPDX-License-Identifier: BSD-3-Clause
// The water of a run, which may change: which environment holds at which instant.
//
// A run starts with one environment; changes follow, from the scenario and from whoever announces them. Each
// sets some of wind, shipping, sea surface and sound-speed profile from an instant on, and leaves the rest.
// One that is announced late (its instant lies before what has been published) holds from the instant at
// which it was received: what is published stays true. Changes of one instant apply in the order of their
// sessions and sequence numbers, so what holds is a function of what was received and when, not of the order
// in one turn.
//
// Where the environment has a field of temperature and salinity that changes with time, sound has the water
// of the middle of the span of WaterField::period_s that an instant lies in: so many links and packets share
// their searches, and delays jump by what half a span changes. Spans begin at multiples of the period. A
// profile that is announced ends the field.
//
// A value in memory; not thread-safe, also where it is only asked: it keeps the environments that a field
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

// What is set, and to what; empty: as before.
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

  // Session and sequence number of an announcement; session 0 is the scenario.
  struct Origin {
    std::int64_t session = 0, sequence = 0;
    auto operator<=>(const Origin&) const = default;
  };
  // Different for each environment of a run.
  using WaterId = std::int64_t;

  // Throws InvalidArgument when the environment is out of range.
  explicit EnvironmentTimeline(acoustics::Environment initial);

  // A change of the scenario: survives clear(). Throws InvalidArgument when it leads out of range.
  void schedule(SimTime from, const EnvironmentChange& change);
  // One announced by `origin` to hold from `announced_from`, received at `received_at`. Empty when taken (a
  // repetition is); else why not.
  [[nodiscard]] std::string announce(SimTime announced_from, SimTime received_at, Origin origin,
                                     const EnvironmentChange& change);

  // At an instant; a change holds at its very instant. References are valid until the next change is added.
  const acoustics::Environment& at(SimTime instant) const;
  WaterId water_at(SimTime instant) const;
  // The first change, but of a field, after `instant`; never() when none is known.
  SimTime next_change_after(SimTime instant) const;

  // Forgets changes that were announced and superseded before `time`, but for the latest kAnnouncedKept, of
  // which repetitions may still arrive. No instant before `time` is evaluated any more.
  void forget_before(SimTime time);
  std::size_t changes_kept() const { return spans_.size() - 1; }

  // Another run: forgets what was announced, keeps the schedule.
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
  // Of a field's spans, from 0; 0 where it does not change.
  static std::int64_t step_of(const acoustics::Environment& environment, SimTime instant);
  void insert(const Order& order, const EnvironmentChange& change);

  std::vector<Span> spans_;  // by order; the first is the initial environment
  WaterId last_id_ = 0;
  // Environments with the field as it is at other times, by their water.
  mutable std::map<WaterId, acoustics::Environment> field_waters_;
};

}  // namespace halocline::channel_server
