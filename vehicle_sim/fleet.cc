#include "vehicle_sim/fleet.h"

#include <utility>

#include "core/check.h"
#include "vehicle_sim/equations_of_motion.h"

namespace halocline::vehicle_sim {

Fleet::Fleet(const FleetSettings& settings, std::vector<FleetMember> members,
             std::shared_ptr<const Seabed> seabed, SimTime start)
    : settings_(settings),
      members_(std::move(members)),
      world_(std::move(seabed), settings.seabed_friction),
      time_(start) {
  require_in_range(settings.step.seconds(), 1e-3, VehicleWorld::kLongestStep_s, "physics step", "s");
  for (const FleetMember& member : members_) {
    commands_.emplace_back(settings.command_timeout);
    obeyed_.push_back(kSafeState);
    world_index_.push_back(world_.size());
    if (!member.model) continue;
    world_.add(member.model, member.start);
    world_.set_water(world_index_.back(), settings.water);
  }
}

CommandVerdict Fleet::command(std::size_t index, const TimedCommand& command) {
  return moves(index) ? commands_[index].add(command, time_) : CommandVerdict::kTaken;
}

void Fleet::advance(SimTime until) {
  while (time_ + settings_.step <= until) {
    for (std::size_t i = 0; i < members_.size(); ++i) {
      if (!moves(i)) continue;
      obeyed_[i] = commands_[i].at(time_);
      world_.set_command(world_index_[i], obeyed_[i]);
    }
    world_.step(settings_.step.seconds());
    time_ = time_ + settings_.step;
  }
}

VehicleState Fleet::state_at(std::size_t index, SimTime when) const {
  if (!moves(index)) return members_[index].start;
  const VehicleState& state = world_.state(world_index_[index]);
  const SimDuration ahead = when - time_;
  ensure(ahead >= SimDuration() && ahead < settings_.step, "a state was asked for out of its time");
  if (ahead == SimDuration() || is_lost(index)) return state;
  return rk4_step(*members_[index].model, state, obeyed_[index], settings_.water, ahead.seconds());
}

SensorReading Fleet::reading_at(std::size_t index, SimTime when) const {
  const VehicleState state = state_at(index, when);
  if (!moves(index)) return measure_fixed(state, settings_.water);
  SensorReading reading = measure(*members_[index].model, state, settings_.water);
  reading.safe_state = commands_[index].is_safe_state();
  reading.on_seabed = on_seabed(index);
  return reading;
}

bool Fleet::is_lost(std::size_t index) const { return moves(index) && world_.is_lost(world_index_[index]); }

bool Fleet::on_seabed(std::size_t index) const {
  return moves(index) && !world_.seabed_force_ned_n(world_index_[index]).isZero(0);
}

}  // namespace halocline::vehicle_sim
