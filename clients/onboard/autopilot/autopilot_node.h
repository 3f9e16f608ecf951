// SPDX-License-Identifier: BSD-3-Clause
// Node that pilots the vehicles that have a mission.
//
// Bus channels:
//   in   STATE, SENSORS         navigation state, see below
//   out  COMMAND                on the time grid
//   out  PLAN                   at each change and once a minute
//   out  AUTOPILOT              at each change and once a second
//   out  SEND                   position reports of a formation leader
//   in   RECEIVE                reports of the leader, at a follower
//   out  BEST_PLACE_QUERY       from vehicles that seek a link
//
// Position and attitude come from STATE (the true position), speed through the water and altitude from
// SENSORS if the vehicle publishes it. With navigate_by = sensors all of them come from SENSORS
// (navigator.h), from DVL, GPS and USBL where the vehicle has these sensors, and from ESTIMATE where a
// localiser publishes it; STATE is then not used, and z is the depth below the sea surface. A vehicle whose
// state (or sensors) is older than the time-out gets no commands, so that it enters its safe state.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/numbered_publisher.h"
#include "bus/runtime/node.h"
#include "bus/transport/node_identity.h"
#include "clients/onboard/autopilot/autopilot_config.h"
#include "clients/onboard/autopilot/formation_link.h"
#include "clients/onboard/autopilot/guidance.h"
#include "clients/onboard/autopilot/navigation/attitude_keeper.h"
#include "clients/onboard/autopilot/navigation/navigator.h"
#include "clients/onboard/autopilot/place_finder.h"
#include "clients/onboard/autopilot/plan.h"
#include "clients/onboard/autopilot/vehicle_pilot.h"
#include "clients/onboard/clocks/vehicle_time.h"
#include "core/archive.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::clients {

class AutopilotNode : public bus::Node {
 public:
  // Pilots the vehicles of `config` that have waypoints or behaviours. Throws InvalidArgument when
  // config.only_vehicle names a vehicle without a mission.
  AutopilotNode(lcm::LCM& lcm, bus::NodeIdentity identity, const AutopilotConfig& config);

 protected:
  bus::Due on_due() const override;
  void on_step(const bus::Now& now) override;
  void on_restart(const bus::Now& now) override;
  void on_archive(Archive& a) override;
  std::string status_text() const override;

 private:
  // Contents of the latest PLAN and AUTOPILOT messages, and when they are due again.
  struct Reported {
    SimTime plan_due, status_due;
    Activity activity = Activity::kWaitingForState;
    DepthRule depth_rule = DepthRule::kPlanned;
    std::size_t behaviour = 0, waypoint = 0;
    bool ended = false;
  };
  struct Pilot {
    PilotConfig config;
    std::optional<vehicle_state_t> state;
    std::optional<vehicle_sensors_t> sensors;
    bool altitude_taken = false;  // the pilot has the altitude in `sensors`
    VehiclePilot pilot;
    std::int64_t sequence = 0;
    std::optional<Navigator> navigator{};      // with navigate_by = sensors
    std::optional<AttitudeKeeper> attitude{};  // with navigate_by = sensors
    std::optional<Situation> situation{};      // at the latest command
    std::unique_ptr<FormationLink> link{};
    std::unique_ptr<PlaceFinder> finder{};
    std::optional<vehicle_dvl_t> ping{};     // latest ping that measured a velocity over ground
    std::map<std::int32_t, Vec3> beacons{};  // positions by vehicle id
    Reported reported{};

    std::optional<vehicle_dvl_t> fresh_ping(std::int64_t utime) const;
    void archive(Archive& a);
  };

  void add_pilot(const AutopilotConfig& all, const PilotConfig& config);
  void subscribe(Pilot& pilot);
  void subscribe_fixes(Pilot& pilot);
  static void dead_reckon(Pilot& pilot, const vehicle_sensors_t& sensors);
  void join_formation(const AutopilotConfig& all, Pilot& pilot);
  std::optional<Situation> situation_of(Pilot& pilot, SimTime instant) const;
  void command_all(SimTime instant);
  bool is_fresh(std::int64_t utime, SimTime now) const;
  vehicle_command_t command_for(Pilot& pilot, const SetPoints& points, const Situation& situation) const;
  SetPoints steer(Pilot& pilot, const Situation& situation, SimTime instant);
  void report(Pilot& pilot, const std::optional<SetPoints>& points, SimTime instant);
  static void take_altimeter_sample(Pilot& pilot, const Situation& situation);
  void report_progress(const Pilot& pilot, const std::optional<PlanProgress>& before);

  SimDuration period_, state_timeout_;
  VehicleTime clocks_;
  SimTime next_command_;
  bus::NumberedPublisher publisher_{bus()};
  std::vector<std::unique_ptr<Pilot>> pilots_;  // in the scenario's order; handlers hold pointers to them
};

}  // namespace halocline::clients
