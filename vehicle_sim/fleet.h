// SPDX-License-Identifier: BSD-3-Clause
// The vehicles of a scenario that we move, on a grid of physics steps, with their commands and sensors.
//
// Time runs in whole steps from the start; a state between two steps is a look ahead from the earlier one
// that changes nothing, so the motion does not depend on how often anyone looks. The same
// commands with the same times give the same motion, bit by bit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/archive.h"
#include "core/for_each.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "ocean/ocean_field.h"
#include "vehicle_sim/dynamics/command_schedule.h"
#include "vehicle_sim/dynamics/currents.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/dynamics/waves.h"
#include "vehicle_sim/faults.h"
#include "vehicle_sim/power/battery.h"
#include "vehicle_sim/sensors/sensors.h"
#include "vehicle_sim/world/seabed.h"
#include "vehicle_sim/world/vehicle_world.h"

namespace halocline::vehicle_sim {

// One vehicle at the start.
struct FleetMember {
  std::string name;
  std::shared_ptr<const Model> model;           // null: fixed, its pose never changes
  VehicleState start;                           // velocity over ground; zero for a fixed one
  std::optional<BatterySettings> battery = {};  // none: it has all the energy it needs
};

// The power of a vehicle went with the charge of its battery, or came back.
struct PowerChange {
  SimTime at;
  std::size_t member = 0;
  bool has_power = false;
};

// A rope from a member that moves to another member, or to a fixed point.
struct FleetTether {
  std::size_t member = 0;
  Vec3 attached_at_m = Vec3::Zero();     // from CO, body frame
  std::optional<std::size_t> to_member;  // empty: a fixed point
  Vec3 to_attached_at_m = Vec3::Zero();  // body frame of the other member; of a fixed point, the world frame
  double length_m = 1;                   // above 0
};

struct FleetSettings {
  SimDuration step = SimDuration::from_milliseconds(10);               // 1 to 20 ms
  SimDuration command_timeout = SimDuration::from_milliseconds(2000);  // above 0
  double sea_surface_z_m = 0;
  CurrentSettings current;
  std::shared_ptr<const ocean::OceanField> ocean;  // whose currents are added; null: none
  WaveSettings waves;
  std::uint64_t seed = 1;  // of random currents and waves
  double seabed_friction = VehicleWorld::kDefaultFriction;
  std::vector<FleetTether> tethers;
};

class Fleet {
 public:
  // All members are where they start at `start`. `seabed` may be null: no ground.
  // `for_each` shares a step among threads; the motion is the same bit by bit.
  Fleet(const FleetSettings& settings, std::vector<FleetMember> members, std::shared_ptr<const Seabed> seabed,
        SimTime start, ForEach for_each = one_after_the_other);

  std::size_t size() const { return members_.size(); }
  const FleetMember& member(std::size_t index) const { return members_[index]; }
  SimTime time() const { return time_; }  // reached in whole steps

  // Schedules a command for a vehicle; it holds from the first physics step at or after its time. Fixed
  // vehicles ignore commands.
  [[nodiscard]] CommandVerdict command(std::size_t index, const TimedCommand& command);

  // Schedules another current; it holds from the first physics step at or after `from`, of two for one
  // instant the one scheduled later. Throws InvalidArgument where it is impossible; false, and no change,
  // when too many wait.
  [[nodiscard]] bool change_current(SimTime from, const CurrentSettings& current);

  // Schedules a fault or its end; of two for one instant the one scheduled later comes later. Of fixed
  // vehicles only sensors fail. False, and no change, when too many wait.
  [[nodiscard]] bool apply_fault(std::size_t index, const Fault& fault);
  const VehicleFaults& faults(std::size_t index) const { return faults_[index]; }

  // Null without a battery.
  const Battery* battery(std::size_t index) const;
  // A packet takes energy from the battery at `at`; without a battery of no effect.
  void spend_on_packet(std::size_t index, SimTime at, PacketEnergy cause, double energy_j);
  // Since the last call.
  std::vector<PowerChange> take_power_changes() { return std::exchange(power_changes_, {}); }

  // All that changes as time goes on. Loads into a fleet made of the same settings and members.
  void archive(Archive& a);

  // Takes all whole steps that end at or before `until`.
  void advance(SimTime until);

  // Where a vehicle is at `when`, time() <= when < time() + step.
  VehicleState state_at(std::size_t index, SimTime when) const;
  // The state that others see: that of its modem's transducer, where the model has it off the hull's middle.
  KinematicState published_at(std::size_t index, SimTime when) const;
  // What its sensors would measure then without errors; altitude is left unavailable. Depth is that of the
  // water's pressure.
  SensorReading reading_at(std::size_t index, SimTime when) const;

  double tether_distance_m(std::size_t tether) const { return world_.tether_distance_m(tether); }
  double tether_pull_n(std::size_t tether) const { return world_.tether_pull_n(tether); }  // in the last step

  // z of the surface that a vehicle floats on, above or below a point.
  double sea_surface_z_m(std::size_t index, const Vec3& point_ned_m, SimTime when) const;

  bool has_diverged(std::size_t index) const;  // VehicleWorld::has_diverged
  bool on_seabed(std::size_t index) const;     // touched the ground in the last step

 private:
  struct CurrentChange {
    SimTime from;
    OceanCurrent current;
  };

  struct FaultOf {
    std::size_t member;
    Fault fault;
  };

  bool moves(std::size_t index) const { return members_[index].model != nullptr; }
  void tie(const FleetTether& tether);
  [[nodiscard]] bool take_due_current();  // true when one was due
  void take_due_faults();
  void archive_currents(Archive& a);
  void set_broken_model(std::size_t member);
  void fill_leaks();    // over the step from time() on
  void spend_energy();  // over the step from time() on
  void end_power();     // of those whose battery is empty at time()
  const Model& model_of(std::size_t index) const { return world_.model(world_index_[index]); }
  ModelParameters sound_parameters(
      std::size_t member) const;  // without faults, and without a weight that is released
  bool has_released(std::size_t member) const;
  void drop_weights();
  bool water_varies() const;
  bool rides_waves(std::size_t index) const;
  // The water at a vehicle for the step from time() on.
  Water water_at(std::size_t index, const Vec3& position_ned_m) const;
  void move_surface(std::size_t index, const Vec3& position_ned_m, Water& water) const;
  // Sets the water of every vehicle for the step from time() on.
  void move_water();

  FleetSettings settings_;
  std::vector<FleetMember> members_;
  std::vector<std::size_t> world_index_;  // of members that move
  std::vector<CommandSchedule> commands_;
  std::vector<ActuatorValues> obeyed_;
  VehicleWorld world_;
  SimTime time_;
  OceanCurrent current_;
  WaterMotion current_everywhere_;              // for the step from time_ on
  std::vector<CurrentChange> current_changes_;  // ascending in time
  WaveField waves_;
  std::vector<VehicleFaults> faults_;
  std::vector<FaultOf> waiting_faults_;                     // ascending in time
  std::vector<std::size_t> leaking_;                        // members that leak or have leaked, ascending
  std::vector<std::size_t> weighted_;                       // members that have a weight to drop, ascending
  std::vector<std::pair<std::size_t, Battery>> batteries_;  // by member, ascending
  std::vector<PowerChange> power_changes_;
};

}  // namespace halocline::vehicle_sim
