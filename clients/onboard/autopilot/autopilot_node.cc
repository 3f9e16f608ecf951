// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/autopilot_node.h"

#include <algorithm>
#include <utility>

#include "bus/transport/subscription.h"
#include "clients/onboard/autopilot/autopilot_messages.h"
#include "clients/onboard/autopilot/formation.h"
#include "clients/onboard/autopilot/seabed_ahead.h"
#include "core/check.h"
#include "core/csv_table.h"

namespace halocline::clients {
namespace {

constexpr SimDuration kPlanPeriod = SimDuration::from_milliseconds(60'000);
constexpr SimDuration kStatusPeriod = SimDuration::from_milliseconds(1000);
// Age up to which a ping of the Doppler log gives the velocity; beyond it, the speed through the water does.
constexpr SimDuration kDvlFreshFor = SimDuration::from_milliseconds(1500);

// Returns the latest instant of the grid at or before `time`.
SimTime grid_instant(SimTime time, SimDuration period) { return next_on_grid(time, period) - period; }

}  // namespace

AutopilotNode::AutopilotNode(lcm::LCM& lcm, bus::NodeIdentity identity, const AutopilotConfig& config)
    : Node(lcm, std::move(identity)),
      period_(config.command_period),
      state_timeout_(config.state_timeout),
      clocks_(bus(), config.clocks) {
  for (const PilotConfig& vehicle : config.vehicles) {
    const bool wanted = config.only_vehicle.empty() || config.only_vehicle == vehicle.vehicle;
    if (wanted && vehicle.is_piloted()) add_pilot(config, vehicle);
  }
  require(config.only_vehicle.empty() || !pilots_.empty(),
          "autopilot.only_vehicle is '" + config.only_vehicle + "', which is no vehicle with a mission");
}

void AutopilotNode::add_pilot(const AutopilotConfig& all, const PilotConfig& config) {
  const SeabedRules rules{.min_altitude_m = config.mission.min_altitude_m};
  const VehiclePilot vehicle_pilot(make_plan(config.mission, config.behaviours), rules);
  pilots_.push_back(std::make_unique<Pilot>(Pilot{config, {}, {}, false, vehicle_pilot}));
  pilots_.back()->beacons = beacons_of(all, config);
  subscribe(*pilots_.back());
  join_formation(all, *pilots_.back());
  const auto seeks = [](const Behaviour& behaviour) { return behaviour.kind == BehaviourKind::kSeekLink; };
  if (std::any_of(config.behaviours.begin(), config.behaviours.end(), seeks))
    pilots_.back()->finder = std::make_unique<PlaceFinder>(bus(), config.vehicle);
}

void AutopilotNode::subscribe(Pilot& pilot) {
  const PilotConfig& config = pilot.config;
  const bool by_sensors = config.navigate_by == NavigateBy::kSensors;
  if (by_sensors) {
    pilot.navigator.emplace(config.start_ned_m, config.navigator);
    pilot.attitude.emplace(config.navigator.gyro_bias_radps);
    subscribe_fixes(pilot);
  } else {
    bus().subscribe_newest<vehicle_state_t>(bus::channels::kState.of(config.vehicle),
                                            [&pilot](const vehicle_state_t& state) { pilot.state = state; });
  }
  bus().subscribe_newest<vehicle_sensors_t>(bus::channels::kSensors.of(config.vehicle),
                                            [&pilot](const vehicle_sensors_t& sensors) {
                                              pilot.sensors = sensors;
                                              pilot.altitude_taken = false;
                                              if (pilot.navigator) dead_reckon(pilot, sensors);
                                            });
}

void AutopilotNode::dead_reckon(Pilot& pilot, const vehicle_sensors_t& sensors) {
  pilot.attitude->add(to_attitude_reading(sensors));
  pilot.navigator->add(to_navigation_sample(sensors, *pilot.attitude, pilot.fresh_ping(sensors.utime)));
}

void AutopilotNode::subscribe_fixes(Pilot& pilot) {
  const std::string& name = pilot.config.vehicle;
  bus().subscribe<position_estimate_t>(
      bus::channels::kEstimate.of(name),
      [&pilot](const position_estimate_t& estimate) { take_in(estimate, *pilot.navigator); },
      bus::Wakeup::kStoreOnly);
  bus().subscribe_newest<vehicle_dvl_t>(bus::channels::kDvl.of(name), [&pilot](const vehicle_dvl_t& ping) {
    if (ping.ground_velocity_valid) pilot.ping = ping;
  });
  bus().subscribe<vehicle_gps_t>(
      bus::channels::kGps.of(name), [&pilot](const vehicle_gps_t& fix) { take_in(fix, *pilot.navigator); },
      bus::Wakeup::kStoreOnly);
  bus().subscribe<vehicle_usbl_t>(
      bus::channels::kUsbl.of(name),
      [&pilot](const vehicle_usbl_t& bearing) {
        take_in(bearing, pilot.beacons, pilot.config.acoustic_fix, *pilot.navigator);
      },
      bus::Wakeup::kStoreOnly);
}

std::optional<vehicle_dvl_t> AutopilotNode::Pilot::fresh_ping(std::int64_t utime) const {
  const bool is_fresh = ping && SimTime::from_utime(utime) - SimTime::from_utime(ping->utime) <= kDvlFreshFor;
  return is_fresh ? ping : std::nullopt;
}

void AutopilotNode::join_formation(const AutopilotConfig& all, Pilot& pilot) {
  std::map<std::int32_t, std::string> leaders;
  for (const Behaviour& behaviour : pilot.config.behaviours) {
    if (behaviour.kind != BehaviourKind::kFollow) continue;
    const PilotConfig* leader = find_leader(all, behaviour.formation.leader);
    require(leader != nullptr,
            "the leader '" + behaviour.formation.leader + "' is no vehicle that broadcasts");
    leaders[leader->vehicle_id] = leader->vehicle;
  }
  if (leaders.empty() && pilot.config.broadcast.period <= SimDuration()) return;
  const auto listener = [&pilot](const std::string& leader, const LeaderReport& report) {
    pilot.pilot.on_leader_report(leader, report);
  };
  pilot.link = std::make_unique<FormationLink>(bus(), pilot.config, std::move(leaders), listener, clocks_);
}

bus::Due AutopilotNode::on_due() const {
  bus::Due due{.sim = pilots_.empty() ? SimTime::never() : next_command_};
  for (const auto& pilot : pilots_) {
    if (!pilot->link) continue;
    const bus::Due link = pilot->link->due();
    due.sim = std::min(due.sim, link.sim);
    due.steady = std::min(due.steady, link.steady);
  }
  return due;
}

void AutopilotNode::on_step(const bus::Now& now) {
  clocks_.set_now(now.sim);
  if (now.sim >= next_command_) {
    command_all(grid_instant(now.sim, period_));
    next_command_ = next_on_grid(now.sim, period_);
  }
  for (const auto& pilot : pilots_) {
    if (pilot->link) pilot->link->step(now, pilot->situation);
  }
}

void AutopilotNode::command_all(SimTime instant) {
  for (const auto& pilot : pilots_) {
    pilot->situation = situation_of(*pilot, instant);
    std::optional<SetPoints> points;
    if (pilot->situation) points = steer(*pilot, *pilot->situation, instant);
    report(*pilot, points, instant);
  }
}

bool AutopilotNode::is_fresh(std::int64_t utime, SimTime now) const {
  return now - SimTime::from_utime(utime) <= state_timeout_;
}

std::optional<Situation> AutopilotNode::situation_of(Pilot& pilot, SimTime instant) const {
  const bool has_sensors = pilot.sensors && is_fresh(pilot.sensors->utime, instant);
  const bool has_state = pilot.state && is_fresh(pilot.state->utime, instant);
  if (!(pilot.navigator ? has_sensors : has_state)) return std::nullopt;
  const double time_s = instant.seconds();
  Situation situation = pilot.navigator ? to_situation(*pilot.sensors, *pilot.navigator, time_s)
                                        : to_situation(*pilot.state, instant);
  if (has_sensors) {
    situation.water_speed_mps = pilot.sensors->water_speed_mps;
    take_altimeter_sample(pilot, situation);
  }
  return situation;
}

// Adds an altitude measurement to the pilot once, though each is seen at several command instants.
void AutopilotNode::take_altimeter_sample(Pilot& pilot, const Situation& situation) {
  const bool known = pilot.sensors->altitude_status != vehicle_sensors_t::ALTITUDE_UNAVAILABLE;
  if (known && !pilot.altitude_taken)
    pilot.pilot.add_altimeter_sample(to_altimeter_sample(*pilot.sensors, situation));
  pilot.altitude_taken = true;
}

vehicle_command_t AutopilotNode::command_for(Pilot& pilot, const SetPoints& points,
                                             const Situation& situation) const {
  const PilotConfig& config = pilot.config;
  const double dt_s = period_.seconds();
  switch (config.steering) {
    case Steering::kThrusters:
      return to_message(pilot.pilot.with_thrusters(config.hover_gains, points, situation, dt_s));
    case Steering::kBuoyancy:
      return to_message(pilot.pilot.by_buoyancy(config.glide, config.gains, points, situation, dt_s));
    case Steering::kFins:
      break;
  }
  return to_message(pilot.pilot.with_fins(config.gains, points, situation, dt_s));
}

SetPoints AutopilotNode::steer(Pilot& pilot, const Situation& situation, SimTime instant) {
  const auto before = pilot.pilot.progress();
  const auto phase_before = pilot.pilot.follow_phase();
  if (pilot.finder && pilot.finder->step(instant, pilot.pilot.seeker())) {
    const Vec3& place = pilot.pilot.seeker()->chosen();
    bus().log().info("better-heard",
                     "vehicle=" + pilot.config.vehicle + " north_m=" + format_number(place.x()) +
                         " east_m=" + format_number(place.y()) + " z_m=" + format_number(place.z()));
  }
  SetPoints points = pilot.pilot.steer_for(situation);
  if (pilot.config.steering == Steering::kBuoyancy) points.speed_mps = 0;  // follows from the buoyancy
  report_progress(pilot, before);
  if (const auto phase = pilot.pilot.follow_phase(); phase && phase != phase_before)
    bus().log().info("formation", "vehicle=" + pilot.config.vehicle + " now=\"" + to_text(*phase) + "\"");
  vehicle_command_t message = command_for(pilot, points, situation);
  message.release_weight = points.surface ? 1 : 0;
  message.utime = instant.to_utime();
  message.session = bus().identity().session;
  message.sequence = pilot.sequence++;
  bus().publish(bus::channels::kCommand.of(pilot.config.vehicle), message);
  return points;
}

void AutopilotNode::report(Pilot& pilot, const std::optional<SetPoints>& points, SimTime instant) {
  const PlanProgress progress = pilot.pilot.progress().value_or(PlanProgress());
  Activity activity = pilot.pilot.activity();
  if (!points && activity != Activity::kWaitingForState) activity = Activity::kLostState;
  const DepthRule depth_rule = points ? points->depth_rule : DepthRule::kPlanned;
  const bool ended = progress.ended || progress.route.at_end;
  Reported& last = pilot.reported;
  const bool moved_on =
      progress.index != last.behaviour || progress.route.target != last.waypoint || ended != last.ended;
  if (moved_on || instant >= last.plan_due) {
    vehicle_plan_t plan = to_message(pilot.pilot.plan(), progress, pilot.config);
    plan.utime = instant.to_utime();
    publisher_.publish(bus::channels::kPlan.of(pilot.config.vehicle), std::move(plan));
    last.plan_due = next_on_grid(instant, kPlanPeriod);
  }
  if (moved_on || activity != last.activity || depth_rule != last.depth_rule || instant >= last.status_due) {
    autopilot_status_t status = to_message(activity, progress, points);
    status.utime = instant.to_utime();
    publisher_.publish(bus::channels::kAutopilot.of(pilot.config.vehicle), status);
    last.status_due = next_on_grid(instant, kStatusPeriod);
  }
  last = {last.plan_due, last.status_due, activity, depth_rule, progress.index, progress.route.target, ended};
}

void AutopilotNode::report_progress(const Pilot& pilot, const std::optional<PlanProgress>& before) {
  if (!before) return;
  const PlanProgress& now = *pilot.pilot.progress();
  const bool reached = now.route.target != before->route.target || now.route.at_end != before->route.at_end;
  if (now.index == before->index && now.ended == before->ended && !reached) return;
  bus().log().info("mission-progress", "vehicle=" + pilot.config.vehicle +
                                           " behaviour=" + std::to_string(before->index) +
                                           " waypoint=" + std::to_string(before->route.target) + " now=\"" +
                                           pilot.pilot.text() + "\"");
}

void AutopilotNode::on_restart(const bus::Now& now) {
  next_command_ = SimTime();
  clocks_.restart(now.sim);
  for (const auto& pilot : pilots_) {
    pilot->state.reset();
    pilot->sensors.reset();
    pilot->ping.reset();
    pilot->situation.reset();
    pilot->reported = {};
    pilot->pilot.restart();
    if (pilot->navigator) {
      pilot->navigator.emplace(pilot->config.start_ned_m, pilot->config.navigator);
      pilot->attitude.emplace(pilot->config.navigator.gyro_bias_radps);
    }
    if (pilot->link) pilot->link->restart(now.sim);
    if (pilot->finder) pilot->finder->restart();
  }
}

void AutopilotNode::on_archive(Archive& a) {
  a(next_command_, publisher_, clocks_);
  for (const auto& pilot : pilots_) a(*pilot);
}

void AutopilotNode::Pilot::archive(Archive& a) {
  a(state, sensors, altitude_taken, pilot, sequence, situation, ping, reported);
  if (navigator) a(*navigator, *attitude);
  if (link) a(*link);
  if (finder) a(*finder);
}

std::string AutopilotNode::status_text() const {
  std::string text = pilots_.empty() ? "no vehicle has a mission" : "";
  for (const auto& pilot : pilots_) {
    text += (text.empty() ? "" : ", ") + pilot->config.vehicle + ": " + pilot->pilot.text();
  }
  return text;
}

}  // namespace halocline::clients
