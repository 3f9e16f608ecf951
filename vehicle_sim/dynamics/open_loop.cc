// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/dynamics/open_loop.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "core/check.h"
#include "vehicle_sim/dynamics/actuators.h"

namespace halocline::vehicle_sim {
namespace {

constexpr double kShortestStep = 1e-4, kLongestStep = 0.02;  // s

void check(const OpenLoopRun& run) {
  require_in_range(run.step.seconds(), kShortestStep, kLongestStep, "step", "s");
  require(run.duration >= SimDuration(), "the duration must be 0 or above");
  require(run.sample_period > SimDuration(), "the sample period must be above 0");
  require(is_finite(run.start), "the state at the start is not finite");
  for (std::size_t i = 0; i < run.schedule.size(); ++i) {
    require(is_finite(run.schedule[i].actuators), "a command is not finite");
    require(i == 0 || run.schedule[i - 1].from < run.schedule[i].from, "the times of the commands must rise");
  }
}

// Returns the angle nearest to `near` that differs from `angle` by whole turns.
double unwrapped(double angle, double near) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return angle + kTurn * std::round((near - angle) / kTurn);
}

}  // namespace

Diverged::Diverged(SimTime at)
    : std::runtime_error("the vehicle's motion diverged: its state is not finite at " +
                         std::to_string(at.seconds()) + " s"),
      at_(at) {}

std::vector<OpenLoopSample> run_open_loop(const Model& model, const OpenLoopRun& run) {
  check(run);
  const SimTime end = SimTime() + run.duration;
  OpenLoopSample now{SimTime(), run.start, to_euler(run.start.orientation).yaw, {}};
  std::vector<OpenLoopSample> samples;
  std::optional<Model> lightened;  // model without its drop weight, once released
  auto next = run.schedule.begin();
  for (SimTime next_sample;;) {
    for (; next != run.schedule.end() && next->from <= now.time; ++next) now.command = next->actuators;
    if (now.time == next_sample) {
      samples.push_back(now);
      next_sample = next_sample + run.sample_period;
    }
    SimTime until = std::min(next_on_grid(now.time, run.step), next_sample);
    if (next != run.schedule.end()) until = std::min(until, next->from);
    if (until > end) return samples;
    const bool drops = model.parameters().drop_weight.mass_kg > 0 &&
                       now.state.actuators.weight == DropWeightState::kReleased;
    if (drops && !lightened) lightened.emplace(without_weight(model.parameters()));
    now.state = rk4_step(lightened ? *lightened : model, now.state, now.command, run.water,
                         (until - now.time).seconds());
    now.yaw_unwrapped_rad = unwrapped(to_euler(now.state.orientation).yaw, now.yaw_unwrapped_rad);
    now.time = until;
    if (!is_finite(now.state)) throw Diverged(now.time);
  }
}

ModelParameters without_limits(ModelParameters parameters) {
  constexpr double kNoLimit = 1e6;  // Hz
  parameters.fin_servo.max_angle_rad = std::numbers::pi / 2;
  parameters.propeller.max_hz = kNoLimit;
  for (Thruster& thruster : parameters.thrusters) thruster.max_hz = kNoLimit;
  for (SlowActuator* slow : {&parameters.buoyancy_engine.pump, &parameters.moving_mass.drive})
    if (slow->limit > 0) slow->limit = kNoLimit;
  return parameters;
}

}  // namespace halocline::vehicle_sim
