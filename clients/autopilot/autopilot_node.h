// SPDX-License-Identifier: BSD-3-Clause
// Steers the vehicles that have a mission: receives their STATE and SENSORS and publishes their COMMAND on
// the time grid, with PLAN at each change and once a minute and AUTOPILOT at each change and once a second;
// leaders of a formation also publish SEND, followers receive RECEIVE; those that seek a link ask
// by BEST_PLACE_QUERY.
//
// Position and attitude come from STATE (the true position), speed through the water and altitude
// from SENSORS where a vehicle publishes it. With navigate_by = sensors all comes from SENSORS (navigator.h),
// from DVL, GPS and USBL where the vehicle has them, and from ESTIMATE where a localiser publishes it; STATE
// is not used, and z is the depth below the sea surface. A vehicle whose state (or sensors) is older than
// the time-out gets no commands, and so falls into its safe state.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/node_identity.h"
#include "bus/numbered_publisher.h"
#include "bus/runtime/node.h"
#include "clients/autopilot/autopilot_config.h"
#include "clients/autopilot/formation_link.h"
#include "clients/autopilot/guidance.h"
#include "clients/autopilot/navigation/attitude_keeper.h"
#include "clients/autopilot/navigation/navigator.h"
#include "clients/autopilot/place_finder.h"
#include "clients/autopilot/plan.h"
#include "clients/autopilot/vehicle_pilot.h"
#include "clients/clocks/vehicle_time.h"
#include "core/archive.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::clients {

class AutopilotNode : public bus::Node {
 public:
  // Pilots the vehicles of `config` that have waypoints or behaviours. Throws InvalidArgument when
  // config.only_vehicle is none of them.
  AutopilotNode(lcm::LCM& lcm, bus::NodeIdentity identity, const AutopilotConfig& config);

 protected:
  bus::Due on_due() const override;
  void on_step(const bus::Now& now) override;
  void on_restart(const bus::Now& now) override;
  void on_archive(Archive& a) override;
  std::string status_text() const override;

 private:
  // What PLAN and AUTOPILOT held last.
  struct Reported {
    SimTime plan_due, status_due;  // again
    Activity activity = Activity::kWaitingForState;
    DepthRule depth_rule = DepthRule::kPlanned;
    std::size_t behaviour = 0, waypoint = 0;
    bool ended = false;
  };
  struct Pilot {
    PilotConfig config;
    std::optional<vehicle_state_t> state;
    std::optional<vehicle_sensors_t> sensors;
    bool looked = false;  // its altitude was taken in
    VehiclePilot pilot;
    std::int64_t sequence = 0;
    std::optional<Navigator> navigator{};      // by sensors alone
    std::optional<AttitudeKeeper> attitude{};  // likewise
    std::optional<Situation> situation{};      // the latest
    std::unique_ptr<FormationLink> link{};
    std::unique_ptr<PlaceFinder> finder{};
    std::optional<vehicle_dvl_t> ping{};  // the latest that holds a velocity
    std::map<std::int32_t, Vec3> beacons{};
    Reported reported{};

    std::optional<vehicle_dvl_t> fresh_ping(std::int64_t utime) const;
    void archive(Archive& a);
  };

  void add_pilot(const AutopilotConfig& all, const PilotConfig& config);
  void subscribe(Pilot& pilot);
  void subscribe_fixes(Pilot& pilot);
  static void reckon(Pilot& pilot, const vehicle_sensors_t& sensors);
  void join_formation(const AutopilotConfig& all, Pilot& pilot);
  std::optional<Situation> situation_of(Pilot& pilot, SimTime instant) const;
  void command_all(SimTime instant);
  bool is_fresh(std::int64_t utime, SimTime now) const;
  // What it steered for.
  vehicle_command_t command_for(Pilot& pilot, const SetPoints& points, const Situation& situation) const;
  SetPoints steer(Pilot& pilot, const Situation& situation, SimTime instant);
  void report(Pilot& pilot, const std::optional<SetPoints>& points, SimTime instant);
  static void look_at_ground(Pilot& pilot, const Situation& situation);
  void report_progress(const Pilot& pilot, const std::optional<PlanProgress>& before);

  SimDuration period_, state_timeout_;
  VehicleTime clocks_;
  SimTime next_command_;
  bus::NumberedPublisher publisher_{bus()};
  std::vector<std::unique_ptr<Pilot>> pilots_;  // in the scenario's order; handlers hold their addresses
};

}  // namespace halocline::clients
