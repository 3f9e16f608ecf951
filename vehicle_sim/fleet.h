// SPDX-License-Identifier: BSD-3-Clause
// Fleet: the vehicles of a scenario that this simulator moves, on a grid of physics steps, with their
// commands and sensors.
//
// Time advances in whole steps from the start. A state between two steps is extrapolated from the earlier one
// and changes nothing, so the motion does not depend on how often states are read. The same commands with the
// same times give the same motion, bit by bit.
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
#include "core/tide.h"
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

struct FleetMember {
  std::string name;
  std::shared_ptr<const Model> model;  // null: a fixed vehicle, whose pose changes with the tide alone
  VehicleState start;                  // velocity over ground; zero for a fixed one
  std::optional<BatterySettings> battery = {};  // empty: unlimited energy
  bool floats = false;                          // of a fixed one: its pose follows the tide
};

// Loss of a vehicle's power with the charge of its battery, or its return.
struct PowerChange {
  SimTime at;
  std::size_t member = 0;
  bool has_power = false;
};

// Tether from a member that moves to another member, or to a fixed point.
struct FleetTether {
  std::size_t member = 0;
  Vec3 attached_at_m = Vec3::Zero();     // from CO, body frame
  std::optional<std::size_t> to_member;  // empty: a fixed point
  Vec3 to_attached_at_m = Vec3::Zero();  // body frame of the other member; world frame for a fixed point
  double length_m = 1;                   // above 0
};

struct FleetSettings {
  SimDuration step = SimDuration::from_milliseconds(10);               // 1 to 20 ms
  SimDuration command_timeout = SimDuration::from_milliseconds(2000);  // above 0
  double sea_surface_z_m = 0;                                          // mean
  Tide tide;
  CurrentSettings current;
  std::shared_ptr<const ocean::OceanField> ocean;  // field whose currents are added; null: none
  WaveSettings waves;
  std::uint64_t seed = 1;  // seed of random currents and waves
  std::vector<FleetTether> tethers;
};

class Fleet {
 public:
  // Puts all members at their starts at the time `start`. `seabed` may be null: no seabed. `for_each`
  // distributes the work of a step over threads; the motion is the same bit by bit.
  Fleet(const FleetSettings& settings, std::vector<FleetMember> members, std::shared_ptr<const Seabed> seabed,
        SimTime start, ForEach for_each = one_after_the_other);

  std::size_t size() const { return members_.size(); }
  const FleetMember& member(std::size_t index) const { return members_[index]; }
  SimTime time() const { return time_; }  // end of the last whole step

  // Schedules a command for a vehicle; it holds from the first physics step at or after its time. Fixed
  // vehicles ignore commands.
  [[nodiscard]] CommandVerdict command(std::size_t index, const TimedCommand& command);

  // Schedules another current; it holds from the first physics step at or after `from`. Of two for one
  // instant the one scheduled later holds. Throws InvalidArgument when a setting is out of its range. Returns
  // false, without a change, when too many are waiting.
  [[nodiscard]] bool change_current(SimTime from, const CurrentSettings& current);

  // Schedules a fault or its end; two for one instant apply in the order in which they were scheduled. On
  // fixed vehicles only sensors fail. Returns false, without a change, when too many are waiting.
  [[nodiscard]] bool apply_fault(std::size_t index, const Fault& fault);
  const VehicleFaults& faults(std::size_t index) const { return faults_[index]; }

  // Null for a vehicle without a battery.
  const Battery* battery(std::size_t index) const;
  // Takes the energy of a packet from the battery at `at`; no effect without a battery.
  void spend_on_packet(std::size_t index, SimTime at, PacketEnergy cause, double energy_j);
  // Returns the changes since the last call.
  std::vector<PowerChange> take_power_changes() { return std::exchange(power_changes_, {}); }

  // Archives all that changes with time. Loads into a fleet made of the same settings and members.
  void archive(Archive& a);

  // Advances by all whole steps that end at or before `until`.
  void advance(SimTime until);

  // Returns the state of a vehicle at `when`, time() <= when < time() + step.
  VehicleState state_at(std::size_t index, SimTime when) const;
  // Returns the published state: that of the modem's transducer where the model has it off the hull's middle.
  KinematicState published_at(std::size_t index, SimTime when) const;
  // Returns the measurements at `when` without errors; the altitude is left unavailable. The depth is that of
  // the water's pressure.
  SensorReading reading_at(std::size_t index, SimTime when) const;

  double tether_distance_m(std::size_t tether) const { return world_.tether_distance_m(tether); }
  double tether_pull_n(std::size_t tether) const { return world_.tether_pull_n(tether); }  // in the last step

  // Returns z of the surface on which a vehicle floats, above or below a point.
  double sea_surface_z_m(std::size_t index, const Vec3& point_ned_m, SimTime when) const;

  bool has_diverged(std::size_t index) const;  // VehicleWorld::has_diverged
  bool on_seabed(std::size_t index) const;     // true when it touched the seabed in the last step

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
  [[nodiscard]] bool take_due_current();  // returns true when one was due
  void take_due_faults();
  void archive_currents(Archive& a);
  void set_broken_model(std::size_t member);
  void fill_leaks();    // over the step that starts at time()
  void spend_energy();  // over the step that starts at time()
  void end_power();     // for vehicles whose battery is empty at time()
  const Model& model_of(std::size_t index) const { return world_.model(world_index_[index]); }
  // Parameters without faults, and without a released weight.
  ModelParameters sound_parameters(std::size_t member) const;
  bool has_released(std::size_t member) const;
  void drop_weights();
  bool water_varies() const;
  // z of the still surface with the tide, m.
  double level_z_m(SimTime when) const {
    return settings_.sea_surface_z_m - settings_.tide.height_m(when.seconds());
  }
  bool rides_waves(std::size_t index) const;
  Water water_at(std::size_t index, const Vec3& position_ned_m) const;
  VehicleState fixed_state_at(const FleetMember& member, SimTime when) const;
  void move_surface(std::size_t index, const Vec3& position_ned_m, Water& water) const;
  // Sets the water of every vehicle for the step that starts at time().
  void move_water();

  FleetSettings settings_;
  std::vector<FleetMember> members_;
  std::vector<std::size_t> world_index_;  // in world_, for members that move
  std::vector<CommandSchedule> commands_;
  std::vector<ActuatorValues> obeyed_;
  VehicleWorld world_;
  SimTime time_;
  OceanCurrent current_;
  WaterMotion current_everywhere_;              // for the step that starts at time_
  std::vector<CurrentChange> current_changes_;  // in ascending order of time
  WaveField waves_;
  std::vector<VehicleFaults> faults_;
  std::vector<FaultOf> waiting_faults_;                     // in ascending order of time
  std::vector<std::size_t> leaking_;                        // members with a leak, past or present, ascending
  std::vector<std::size_t> weighted_;                       // members that hold a drop weight, ascending
  std::vector<std::pair<std::size_t, Battery>> batteries_;  // and their members, ascending
  std::vector<PowerChange> power_changes_;
};

}  // namespace halocline::vehicle_sim
