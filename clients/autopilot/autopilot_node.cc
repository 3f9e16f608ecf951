#include "clients/autopilot/autopilot_node.h"

#include <algorithm>

#include "clients/autopilot/autopilot_messages.h"
#include "core/check.h"

namespace halocline::clients {
namespace {

// The latest instant of the grid at or before `time`.
SimTime grid_instant(SimTime time, SimDuration period) { return next_on_grid(time, period) - period; }

// Speed through the water and the height of the seabed, where the vehicle measures them.
void use_sensors(const vehicle_sensors_t& sensors, const Mission& mission, Measured& measured,
                 SetPoints& points) {
  measured.speed_mps = sensors.water_speed_mps;
  if (sensors.altitude_status != vehicle_sensors_t::ALTITUDE_MEASURED) return;
  points.z_ned_m = above_seabed(mission, points.z_ned_m, measured.z_ned_m, sensors.altitude_m);
}

}  // namespace

AutopilotNode::AutopilotNode(lcm::LCM& lcm, bus::NodeIdentity identity, const AutopilotConfig& config)
    : Node(lcm, std::move(identity)), period_(config.command_period), state_timeout_(config.state_timeout) {
  for (const PilotConfig& vehicle : config.vehicles) {
    const bool wanted = config.only_vehicle.empty() || config.only_vehicle == vehicle.vehicle;
    if (wanted && !vehicle.mission.waypoints.empty()) add_pilot(vehicle);
  }
  require(config.only_vehicle.empty() || !pilots_.empty(),
          "autopilot.only_vehicle is '" + config.only_vehicle + "', which is no vehicle with a mission");
}

void AutopilotNode::add_pilot(const PilotConfig& config) {
  pilots_.push_back(std::make_unique<Pilot>());
  Pilot* pilot = pilots_.back().get();
  pilot->config = config;
  bus().subscribe<vehicle_state_t>(bus::channels::kState.of(config.vehicle),
                                   [pilot](const vehicle_state_t& state) { pilot->state = state; });
  bus().subscribe<vehicle_sensors_t>(bus::channels::kSensors.of(config.vehicle),
                                     [pilot](const vehicle_sensors_t& sensors) { pilot->sensors = sensors; });
}

bus::Due AutopilotNode::on_due() const { return {.sim = pilots_.empty() ? SimTime::never() : next_command_}; }

void AutopilotNode::on_step(const bus::Now& now) {
  if (now.sim < next_command_) return;
  const SimTime instant = grid_instant(now.sim, period_);
  for (const auto& pilot : pilots_) {
    if (pilot->state && is_fresh(pilot->state->utime, instant)) steer(*pilot, instant);
  }
  next_command_ = next_on_grid(now.sim, period_);
}

bool AutopilotNode::is_fresh(std::int64_t utime, SimTime now) const {
  return now - SimTime::from_utime(utime) <= state_timeout_;
}

void AutopilotNode::steer(Pilot& pilot, SimTime instant) {
  const Mission& mission = pilot.config.mission;
  const Vec3 position = position_of(*pilot.state);
  const Progress before = pilot.progress.value_or(begin(position));
  pilot.progress = advance(mission, before, position);
  report_progress(pilot, before);
  SetPoints points = set_points(mission, *pilot.progress, position);
  Measured measured = to_measured(*pilot.state);
  if (pilot.sensors && is_fresh(pilot.sensors->utime, instant)) {
    use_sensors(*pilot.sensors, mission, measured, points);
  }
  vehicle_command_t message =
      pilot.config.steering == Steering::kThrusters
          ? steer_with_thrusters(pilot, points)
          : to_message(command(pilot.config.gains, points, measured, period_.seconds(), pilot.integrals));
  message.utime = instant.to_utime();
  message.session = bus().identity().session;
  message.sequence = pilot.sequence++;
  bus().publish(bus::channels::kCommand.of(pilot.config.vehicle), message);
}

// Straight to the waypoint ahead, or to stay at the last one.
vehicle_command_t AutopilotNode::steer_with_thrusters(Pilot& pilot, const SetPoints& points) const {
  if (!points.propel) return {};
  const Mission& mission = pilot.config.mission;
  StationPoint point{mission.waypoints.at(pilot.progress->target), mission.speed_mps};
  point.position_ned_m.z() = points.z_ned_m;
  return to_message(hover_command(pilot.config.hover_gains, point, to_hover_measured(*pilot.state),
                                  period_.seconds(), pilot.hover_integrals));
}

void AutopilotNode::report_progress(const Pilot& pilot, const Progress& before) {
  if (pilot.progress->target == before.target && pilot.progress->at_end == before.at_end) return;
  bus().log().info("waypoint-reached", "vehicle=" + pilot.config.vehicle +
                                           " waypoint=" + std::to_string(before.target) +
                                           (pilot.progress->at_end ? " mission=finished" : ""));
}

void AutopilotNode::on_restart(const bus::Now&) {
  next_command_ = SimTime();
  for (const auto& pilot : pilots_) {
    pilot->state.reset();
    pilot->sensors.reset();
    pilot->progress.reset();
    pilot->integrals = {};
    pilot->hover_integrals = {};
  }
}

std::string AutopilotNode::status_text() const {
  std::string text = pilots_.empty() ? "no vehicle has a mission" : "";
  for (const auto& pilot : pilots_) {
    text += (text.empty() ? "" : ", ") + pilot->config.vehicle + ": ";
    text += !pilot->progress          ? "not heard yet"
            : pilot->progress->at_end ? "mission finished"
                                      : "to waypoint " + std::to_string(pilot->progress->target);
  }
  return text;
}

}  // namespace halocline::clients
