// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/fleet.h"

#include <algorithm>

#include "core/check.h"
#include "vehicle_sim/dynamics/actuator_forces.h"
#include "vehicle_sim/dynamics/equations_of_motion.h"
#include "vehicle_sim/dynamics/submergence.h"

namespace halocline::vehicle_sim {

Fleet::Fleet(const FleetSettings& settings, std::vector<FleetMember> members,
             std::shared_ptr<const Seabed> seabed, SimTime start, ForEach for_each)
    : settings_(settings),
      members_(std::move(members)),
      world_(std::move(seabed), VehicleWorld::kDefaultFriction, std::move(for_each)),
      time_(start),
      current_(settings.current, settings.seed),
      waves_(settings.waves, settings.seed),
      faults_(members_.size()) {
  require_in_range(settings.step.seconds(), 1e-3, VehicleWorld::kLongestStep_s, "physics step", "s");
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const FleetMember& member = members_[i];
    const ActuatorValues safe = member.model ? safe_state(member.model->parameters()) : ActuatorValues{};
    commands_.emplace_back(settings.command_timeout, safe);
    obeyed_.push_back(safe);
    world_index_.push_back(world_.size());
    if (member.battery) batteries_.emplace_back(world_index_.size() - 1, *member.battery);
    if (!member.model) continue;
    world_.add(member.model, member.start);
    if (member.model->parameters().drop_weight.mass_kg > 0) weighted_.push_back(i);
  }
  for (const FleetTether& tether : settings.tethers) tie(tether);
  move_water();  // at the starting positions
}

// Adds a tether. An end on a fixed member becomes a fixed point.
void Fleet::tie(const FleetTether& t) {
  require(t.member < members_.size() && moves(t.member), "a tether starts from a vehicle that moves");
  require(!t.to_member || *t.to_member < members_.size(), "a tether's other end needs a vehicle");
  Tether tether{world_index_[t.member], t.attached_at_m, {}, t.to_attached_at_m, t.length_m};
  if (t.to_member && moves(*t.to_member)) {
    tether.to_vehicle = world_index_[*t.to_member];
  } else if (t.to_member) {
    const VehicleState& post = members_[*t.to_member].start;
    tether.to_attached_at_m = post.position_ned_m + post.orientation * t.to_attached_at_m;
  }
  world_.add(tether);
}

bool Fleet::change_current(SimTime from, const CurrentSettings& current) {
  constexpr std::size_t kMaxWaiting = 1000;
  CurrentChange change{from, OceanCurrent(current, settings_.seed)};
  if (current_changes_.size() >= kMaxWaiting) return false;
  const auto later = [](const CurrentChange& a, const CurrentChange& b) { return a.from < b.from; };
  current_changes_.insert(std::upper_bound(current_changes_.begin(), current_changes_.end(), change, later),
                          std::move(change));
  if (take_due_current()) move_water();
  return true;
}

bool Fleet::take_due_current() {
  std::size_t due = 0;
  while (due < current_changes_.size() && current_changes_[due].from <= time_) ++due;
  if (due == 0) return false;
  current_ = current_changes_[due - 1].current;
  current_changes_.erase(current_changes_.begin(),
                         current_changes_.begin() + static_cast<std::ptrdiff_t>(due));
  return true;
}

bool Fleet::apply_fault(std::size_t index, const Fault& fault) {
  constexpr std::size_t kMaxWaiting = 100'000;
  if (waiting_faults_.size() >= kMaxWaiting) return false;
  const FaultOf entry{index, fault};
  const auto later = [](const FaultOf& a, const FaultOf& b) { return a.fault.from < b.fault.from; };
  waiting_faults_.insert(std::upper_bound(waiting_faults_.begin(), waiting_faults_.end(), entry, later),
                         entry);
  take_due_faults();
  return true;
}

void Fleet::take_due_faults() {
  std::size_t due = 0;
  for (; due < waiting_faults_.size() && waiting_faults_[due].fault.from <= time_; ++due) {
    const auto& [member, fault] = waiting_faults_[due];
    const std::size_t index = world_index_[member];
    faults_[member].take(fault, moves(member) ? world_.state(index).actuators : ActuatorValues{});
    if (fault.kind == FaultKind::kEmptyBattery) power_changes_.push_back({time_, member, fault.fixed});
    if (!moves(member)) continue;
    set_broken_model(member);
    const auto place = std::lower_bound(leaking_.begin(), leaking_.end(), member);
    const bool is_known = place != leaking_.end() && *place == member;
    if (fault.kind == FaultKind::kLeak && !is_known) leaking_.insert(place, member);
  }
  waiting_faults_.erase(waiting_faults_.begin(), waiting_faults_.begin() + static_cast<std::ptrdiff_t>(due));
}

bool Fleet::has_released(std::size_t member) const {
  return world_.state(world_index_[member]).actuators.weight == DropWeightState::kReleased;
}

ModelParameters Fleet::sound_parameters(std::size_t member) const {
  const ModelParameters& whole = members_[member].model->parameters();
  return has_released(member) ? without_weight(whole) : whole;
}

void Fleet::set_broken_model(std::size_t member) {
  const VehicleFaults& faults = faults_[member];
  const bool is_as_at_start = !faults.changes_model() && !has_released(member);
  world_.set_model(world_index_[member],
                   is_as_at_start ? members_[member].model
                                  : std::make_shared<const Model>(faults.broken(sound_parameters(member))));
}

// Removes each released weight from the model; it acts up to the end of the step in which it was released.
void Fleet::drop_weights() {
  std::erase_if(weighted_, [this](std::size_t member) {
    if (!has_released(member)) return false;
    set_broken_model(member);
    return true;
  });
}

// Fills leaks over a step. The model of the step has the mass of water at the middle of the step.
void Fleet::fill_leaks() {
  for (const std::size_t member : leaking_) {
    const ModelParameters sound = sound_parameters(member);
    VehicleFaults& faults = faults_[member];
    if (!faults.is_filling(sound.water_density_kg_m3)) continue;
    VehicleFaults halfway = faults;
    halfway.leak(settings_.step.seconds() / 2, sound.water_density_kg_m3);
    world_.set_model(world_index_[member], std::make_shared<const Model>(halfway.broken(sound)));
    faults.leak(settings_.step.seconds(), sound.water_density_kg_m3);
  }
}

const Battery* Fleet::battery(std::size_t index) const {
  for (const auto& [member, battery] : batteries_) {
    if (member == index) return &battery;
  }
  return nullptr;
}

void Fleet::spend_on_packet(std::size_t index, SimTime at, PacketEnergy cause, double energy_j) {
  for (auto& [member, battery] : batteries_) {
    if (member == index) battery.add_packet(at, cause, energy_j);
  }
}

void Fleet::spend_energy() {
  for (auto& [member, battery] : batteries_) {
    const bool turns = moves(member) && faults_[member].has_power() && !has_diverged(member);
    double shaft_w = 0;
    if (turns) {
      const VehicleState& state = world_.state(world_index_[member]);
      shaft_w = shaft_power_w(model_of(member), state, water_at(member, state.position_ned_m));
    }
    battery.spend(time_ + settings_.step, settings_.step.seconds(), shaft_w);
  }
}

void Fleet::end_power() {
  for (const auto& [member, battery] : batteries_) {
    if (!battery.is_empty() || !faults_[member].has_power()) continue;
    const bool is_taken = apply_fault(member, {.from = time_, .kind = FaultKind::kEmptyBattery});
    ensure(is_taken, "an empty battery is a fault that waits for nothing");
  }
}

bool Fleet::water_varies() const {
  return current_.depends_on_depth() || current_.depends_on_time() || !waves_.calm() || settings_.ocean ||
         settings_.tide.moves();
}

bool Fleet::rides_waves(std::size_t index) const {
  return !waves_.calm() && moves(index) &&
         members_[index].model->parameters().sea_surface == SeaSurface::kWaves;
}

double Fleet::sea_surface_z_m(std::size_t index, const Vec3& point_ned_m, SimTime when) const {
  const double still = level_z_m(when);
  return rides_waves(index) ? still - waves_.elevation_m(point_ned_m, 0, when) : still;
}

Water Fleet::water_at(std::size_t index, const Vec3& position_ned_m) const {
  Water water{.current_ned_mps = current_everywhere_.velocity_mps,
              .sea_surface_z_m = level_z_m(time_),
              .current_rate_ned_mps2 = current_everywhere_.acceleration_mps2};
  const double depth = depth_below_surface_m(position_ned_m, water.sea_surface_z_m);
  if (current_.depends_on_depth()) water.current_ned_mps += current_.at_depth(depth);
  if (settings_.ocean) {
    const WaterMotion field =
        motion_of(*settings_.ocean, {position_ned_m.x(), position_ned_m.y(), depth}, time_, settings_.step);
    water.current_ned_mps += field.velocity_mps;
    water.current_rate_ned_mps2 += field.acceleration_mps2;
  }
  if (!waves_.calm()) {
    const WaterMotion wave = waves_.at(position_ned_m, depth, time_);
    water.current_ned_mps += wave.velocity_mps;
    water.current_rate_ned_mps2 += wave.acceleration_mps2;
  }
  if (rides_waves(index)) move_surface(index, position_ned_m, water);
  return water;
}

// Tangent plane of the surface at the vehicle, z = still level - elevation. The elevation's slope is -a_s /
// g, so
//
//   dz/ds = a_s / g,  dz/dt = v_z
void Fleet::move_surface(std::size_t index, const Vec3& position_ned_m, Water& water) const {
  const ModelParameters& p = members_[index].model->parameters();
  const double least_depth = depth_below_surface_m(position_ned_m, level_z_m(time_)) - waves_.highest_m();
  if (p.floats.empty() && is_wholly_submerged(p.hull, least_depth)) return;
  const WaterMotion surface = waves_.at(position_ned_m, 0, time_);
  water.surface_slope = surface.acceleration_mps2 / WaveField::kGravity;
  water.surface_slope.z() = 0;
  water.surface_rate_mps = surface.velocity_mps.z();
  water.sea_surface_z_m =
      sea_surface_z_m(index, position_ned_m, time_) - water.surface_slope.dot(position_ned_m);
}

void Fleet::move_water() {
  current_everywhere_ = current_.everywhere(time_, settings_.step);
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (moves(i))
      world_.set_water(world_index_[i], water_at(i, world_.state(world_index_[i]).position_ned_m));
  }
}

void Fleet::archive(Archive& a) {
  for (CommandSchedule& schedule : commands_) schedule.archive(a);
  world_.archive(a);
  archive_currents(a);
  a(time_, obeyed_, faults_, waiting_faults_, leaking_);
  for (auto& [member, battery] : batteries_) a(battery);
  if (!a.is_loading()) return;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (moves(i)) set_broken_model(i);
  }
  move_water();
}

// Currents are archived by their settings: a current is a function of its settings, the seed and time.
void Fleet::archive_currents(Archive& a) {
  CurrentSettings current = current_.settings();
  std::vector<std::pair<SimTime, CurrentSettings>> changes;
  for (const CurrentChange& change : current_changes_)
    changes.emplace_back(change.from, change.current.settings());
  a(current, changes);
  if (!a.is_loading()) return;
  current_ = OceanCurrent(current, settings_.seed);
  current_changes_.clear();
  for (const auto& [from, settings] : changes)
    current_changes_.push_back({from, OceanCurrent(settings, settings_.seed)});
}

CommandVerdict Fleet::command(std::size_t index, const TimedCommand& command) {
  return moves(index) ? commands_[index].add(command, time_) : CommandVerdict::kTaken;
}

void Fleet::advance(SimTime until) {
  while (time_ + settings_.step <= until) {
    for (std::size_t i = 0; i < members_.size(); ++i) {
      if (!moves(i)) continue;
      obeyed_[i] = faults_[i].obeyed(commands_[i].at(time_));
      world_.set_command(world_index_[i], obeyed_[i]);
    }
    fill_leaks();
    spend_energy();
    world_.step(settings_.step.seconds());
    time_ = time_ + settings_.step;
    drop_weights();
    take_due_faults();
    end_power();
    if (take_due_current() || water_varies()) move_water();
  }
}

VehicleState Fleet::fixed_state_at(const FleetMember& member, SimTime when) const {
  VehicleState state = member.start;
  if (!member.floats || !settings_.tide.moves()) return state;
  const Tide& tide = settings_.tide;
  state.position_ned_m.z() -= tide.height_m(when.seconds()) - tide.height_m(0);
  state.velocity_body.head<3>() = state.orientation.conjugate() * Vec3(0, 0, -tide.rate_mps(when.seconds()));
  return state;
}

VehicleState Fleet::state_at(std::size_t index, SimTime when) const {
  if (!moves(index)) return fixed_state_at(members_[index], when);
  const VehicleState& state = world_.state(world_index_[index]);
  const SimDuration ahead = when - time_;
  ensure(ahead >= SimDuration() && ahead < settings_.step,
         "a state is known from time() to less than a step later");
  if (ahead == SimDuration() || has_diverged(index)) return state;
  return rk4_step(model_of(index), state, obeyed_[index], water_at(index, state.position_ned_m),
                  ahead.seconds());
}

// State of a point at r from CO:
//
//   p + R r,  R (v + omega x r)
KinematicState Fleet::published_at(std::size_t index, SimTime when) const {
  const VehicleState state = state_at(index, when);
  KinematicState seen = to_kinematic_state(state);
  if (!moves(index)) return seen;
  const Vec3& r = members_[index].model->parameters().transducer_m;
  if (r.isZero(0)) return seen;
  seen.pose.position_ned_m += state.orientation * r;
  seen.velocity_ned_mps += state.orientation * seen.angular_velocity_body_radps.cross(r);
  return seen;
}

SensorReading Fleet::reading_at(std::size_t index, SimTime when) const {
  const VehicleState state = state_at(index, when);
  Water water = water_at(index, state.position_ned_m);
  water.current_ned_mps += (when - time_).seconds() * water.current_rate_ned_mps2;
  if (!moves(index)) return measure_fixed(state, water);
  water.sea_surface_z_m = level_z_m(when);
  if (rides_waves(index)) {
    const double depth = depth_below_surface_m(state.position_ned_m, water.sea_surface_z_m);
    water.sea_surface_z_m -= waves_.elevation_m(state.position_ned_m, depth, when);
  }
  SensorReading reading = measure(model_of(index), state, water);
  reading.safe_state = commands_[index].is_safe_state();
  reading.on_seabed = on_seabed(index);
  return reading;
}

bool Fleet::has_diverged(std::size_t index) const {
  return moves(index) && world_.has_diverged(world_index_[index]);
}

bool Fleet::on_seabed(std::size_t index) const {
  return moves(index) && !world_.seabed_force_ned_n(world_index_[index]).isZero(0);
}

}  // namespace halocline::vehicle_sim
