// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/autopilot_config.h"

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <sstream>

#include "clients/onboard/autopilot/link_seeker.h"
#include "core/check.h"

namespace halocline::clients {
namespace {

using bus::ConfigVisitor;

void visit_gains(ConfigVisitor& v, Gains& g) {
  v.number("heading_p", g.heading_p, {0, 100, "", "rudder per heading error, rad per rad"});
  v.number("heading_d_s", g.heading_d_s, {0, 100, "s", "rudder per yaw rate, rad per rad/s"});
  v.number("depth_p_rad_per_m", g.depth_p_rad_per_m, {0, 10, "rad/m", "pitch per metre of depth error"});
  v.number("depth_i_rad_per_m_s", g.depth_i_rad_per_m_s, {0, 10, "rad/(m s)", "pitch per metre and second"});
  v.number("pitch_p", g.pitch_p, {0, 100, "", "stern plane per pitch error, rad per rad"});
  v.number("pitch_d_s", g.pitch_d_s, {0, 100, "s", "stern plane per pitch rate, rad per rad/s"});
  v.number("speed_feed_forward_rpm_s_per_m", g.speed_feed_forward_rpm_s_per_m,
           {0, 1e5, "rpm s/m", "propeller speed per m/s of set speed"});
  v.number("speed_p_rpm_s_per_m", g.speed_p_rpm_s_per_m,
           {0, 1e5, "rpm s/m", "propeller speed per m/s of speed error"});
  v.number("speed_i_rpm_per_m", g.speed_i_rpm_per_m,
           {0, 1e5, "rpm/m", "propeller speed per metre of the speed error's integral"});
  degrees(v, "max_pitch_deg", g.max_pitch_rad, {0, 60, "deg", "maximum set pitch"});
  degrees(v, "max_fin_deg", g.max_fin_rad, {0, 90, "deg", "maximum rudder and stern plane"});
  v.number("max_rpm", g.max_rpm, {0, 1e5, "rpm", "maximum propeller speed"});
}

void visit_hover_gains(ConfigVisitor& v, HoverGains& g) {
  v.number("position_p_n_per_m", g.position_p_n_per_m, {0.01, 1e5, "N/m", "force per metre of distance"});
  v.number("position_i_n_per_m_s", g.position_i_n_per_m_s, {0, 1e5, "N/(m s)", "force per metre and second"});
  v.number("position_d_n_s_per_m", g.position_d_n_s_per_m, {0, 1e6, "N s/m", "force per speed over ground"});
  v.number("cruise_n_s2_per_m2", g.cruise_n_s2_per_m2,
           {0, 1e6, "N s^2/m^2", "force per square of the set speed, under way"});
  v.number("heading_p_nm", g.heading_p_nm, {0, 1e6, "N m", "moment per rad of heading error"});
  v.number("heading_d_nm_s", g.heading_d_nm_s, {0, 1e6, "N m s", "moment per rad/s of yaw rate"});
  v.number("depth_p_n_per_m", g.depth_p_n_per_m, {0.01, 1e5, "N/m", "force per metre of depth error"});
  v.number("depth_i_n_per_m_s", g.depth_i_n_per_m_s, {0, 1e5, "N/(m s)", "force per depth error and second"});
  v.number("depth_d_n_s_per_m", g.depth_d_n_s_per_m, {0, 1e6, "N s/m", "force against the vertical speed"});
  v.number("pitch_p_nm", g.pitch_p_nm, {0, 1e6, "N m", "moment per rad of pitch error"});
  v.number("pitch_d_nm_s", g.pitch_d_nm_s, {0, 1e6, "N m s", "moment per rad/s of pitch rate"});
  degrees(v, "max_pitch_deg", g.max_pitch_rad, {0, 60, "deg", "maximum set pitch, under way"});
  v.number("min_force_n", g.min_force_n, {0, 1e5, "N", "horizontal force below which the heading is kept"});
  v.number("beside_axis_m", g.beside_axis_m, {0.01, 100, "m", "distance from axis to horizontal thrusters"});
  v.number("from_middle_m", g.from_middle_m, {0.01, 100, "m", "distance from middle to vertical thrusters"});
  v.number("full_thrust_n", g.full_thrust_n, {0.01, 1e6, "N", "thrust of a thruster at full_rpm"});
  v.number("astern_ratio", g.astern_ratio, {0.01, 1, "", "thrust astern over thrust ahead"});
  v.number("full_rpm", g.full_rpm, {1, 1e5, "rpm", "maximum speed of a thruster"});
}

void visit_glide(ConfigVisitor& v, GlideGains& g) {
  v.number("shallow_z_m", g.shallow_z_m,
           {-100, 12000, "m", "z at which a climb ends; a dive ends at the behaviour's depth"});
  degrees(v, "pitch_deg", g.pitch_rad, {1, 60, "deg", "pitch, down on dives, up on climbs"});
  v.advanced([&] {
    v.number("volume_m3", g.volume_m3,
             {0, 1000, "m^3", "volume of the buoyancy engine, less on dives, more on climbs"});
    v.number("mass_p_m_per_rad", g.mass_p_m_per_rad, {0, 1000, "m/rad", "mass shift per rad of pitch error"});
    v.number("mass_i_m_per_rad_s", g.mass_i_m_per_rad_s,
             {0, 1000, "m/(rad s)", "mass shift per pitch error and second"});
    v.number("max_mass_m", g.max_mass_m, {0, 1000, "m", "maximum shift of the moving mass"});
  });
}

const std::vector<std::string> kKinds{"waypoints", "heading", "loiter",   "survey",
                                      "follow",    "wait",    "seek_link"};

// Visits keys that apply only to the behaviours of the given kinds.
void with_kind(ConfigVisitor& v, const Behaviour& b, std::initializer_list<BehaviourKind> kinds,
               const std::function<void()>& body) {
  bus::when_one_of(v, "kind", b.kind, kKinds, kinds, body);
}

void visit_circle(ConfigVisitor& v, Behaviour& b) {
  using Kind = BehaviourKind;
  with_kind(v, b, {Kind::kLoiter, Kind::kSurvey, Kind::kSeekLink}, [&] {
    v.number("center_north_m", b.center_north_m,
             {-1e6, 1e6, "m", "centre of a loiter, of a survey or of the depths of seek_link, north"});
    v.number("center_east_m", b.center_east_m,
             {-1e6, 1e6, "m", "centre of a loiter, of a survey or of the depths of seek_link, east"});
  });
  with_kind(v, b, {Kind::kLoiter, Kind::kFollow, Kind::kSeekLink}, [&] {
    v.number("radius_m", b.radius_m,
             {1, 1e5, "m", "radius of the circle of loiter, of seek_link, and of follow without a leader"});
  });
  with_kind(v, b, {Kind::kLoiter, Kind::kSeekLink}, [&] {
    bus::choice(v, "sense", b.sense, {"clockwise", "counterclockwise"},
                "sense of the circle of loiter and seek_link, seen from above");
  });
}

void visit_where(ConfigVisitor& v, Behaviour& b) {
  using Kind = BehaviourKind;
  const auto visit_altitude = [&] {
    v.number("altitude_m", b.altitude_m, {0, 1000, "m", "height above the seabed, not depth; 0: not used"});
  };
  if (!v.writing()) visit_altitude();
  with_kind(v, b, {Kind::kHeading, Kind::kLoiter, Kind::kSurvey}, [&] {
    v.when(b.altitude_m == 0, "altitude_m = 0", [&] {
      v.number("depth_m", b.depth_m, {-100, 12000, "m", "z of heading, loiter and survey"});
    });
  });
  visit_altitude();
  v.when(b.altitude_m > 0, "altitude_m above 0", [&] {
    v.number("max_depth_m", b.max_depth_m, {0, 12000, "m", "z that is never exceeded to keep an altitude"});
  });
  with_kind(v, b, {Kind::kHeading, Kind::kSurvey}, [&] {
    degrees(v, "heading_deg", b.heading_rad,
            {-360, 360, "deg", "course of heading and a survey's first track"});
  });
  visit_circle(v, b);
  with_kind(v, b, {Kind::kSurvey}, [&] {
    v.number("length_m", b.length_m, {1, 1e5, "m", "length of a survey's box, along the tracks"});
    v.number("width_m", b.width_m, {0, 1e5, "m", "width of a survey's box, across the tracks"});
    v.number("track_spacing_m", b.track_spacing_m, {0.1, 1e4, "m", "distance between a survey's tracks"});
    v.number("turn_m", b.turn_m, {0, 1e4, "m", "length by which a survey's tracks extend beyond the box"});
  });
}

void visit_formation(ConfigVisitor& v, Formation& f) {
  v.text("leader", f.leader, {}, "name of a vehicle with a [vehicle.mission.broadcast]");
  v.number("along_m", f.along_m, {-1e4, 1e4, "m", "place ahead of the leader; below 0: astern"});
  v.number("across_m", f.across_m, {-1e4, 1e4, "m", "place to the leader's starboard"});
  v.number("below_m", f.below_m, {-1e4, 1e4, "m", "place below the leader"});
  v.number("safe_depth_m", f.safe_depth_m,
           {-100, 12000, "m", "z of the circle (radius_m) of a follower that has lost its leader"});
  v.advanced([&] {
    v.number("fresh_for_s", f.fresh_for_s, {1, 60, "s", "age of a report beyond which the leader is lost"});
    v.number("keep_course_s", f.keep_course_s, {0, 1e5, "s", "time for which it keeps the last course"});
    v.number("safe_speed_mps", f.safe_speed_mps, {0.01, 50, "m/s", "speed on the circle without a leader"});
    v.number("max_speed_mps", f.max_speed_mps, {0.01, 50, "m/s", "maximum speed to catch up"});
  });
}

void visit_search(ConfigVisitor& v, Behaviour& b) {
  LinkSearch& s = b.search;
  v.text("listeners", s.listeners, {}, "names of the vehicles that are to receive it, with spaces between");
  v.when(b.waypoints.empty(), "no waypoints", [&] {
    v.number("shallowest_m", s.shallowest_m, {0, 12000, "m", "z of the first depth, without waypoints"});
    v.number("deepest_m", s.deepest_m, {0, 12000, "m", "z of the last depth"});
    v.number("step_m", s.step_m, {0.1, 1000, "m", "distance between depths"});
  });
  v.number("period_s", s.period_s, {2, 1e5, "s", "time between queries for the best place"});
}

// Checks that a behaviour that seeks a link has listeners and places to choose from.
void check_search(ConfigVisitor& v, const Behaviour& b) {
  constexpr std::size_t kMaxLinks = 1600;  // limit on listeners times places in best_place_query_t
  const std::size_t listeners = listeners_of(b.search).size();
  if (listeners == 0) v.problem("search.listeners", "at least one vehicle, with kind = seek_link");
  if (b.waypoints.empty() && b.search.deepest_m < b.search.shallowest_m)
    v.problem("search.deepest_m", "shallowest_m or more");
  else if (places_of(b).size() * listeners > kMaxLinks)
    v.problem("search.listeners", "at most 1600 listeners times places or depths");
}

void visit_behaviour(ConfigVisitor& v, Behaviour& b) {
  using Kind = BehaviourKind;
  bus::choice(v, "kind", b.kind, kKinds, "kind of behaviour");
  with_kind(v, b, {Kind::kWaypoints, Kind::kSeekLink}, [&] {
    v.points("waypoints", b.waypoints,
             {-1e6, 1e6, "m", "points of waypoints, or places of seek_link: north, east, down of each"});
  });
  with_kind(v, b, {Kind::kHeading, Kind::kLoiter, Kind::kFollow, Kind::kWait, Kind::kSeekLink}, [&] {
    v.number("duration_s", b.duration_s,
             {0, 1e7, "s", "duration of heading, loiter, follow, wait and seek_link; 0: unlimited"});
  });
  v.number("speed_mps", b.speed_mps, {0, 50, "m/s", "speed through the water; 0: the mission's"});
  visit_where(v, b);
  with_kind(v, b, {Kind::kFollow}, [&] {
    v.section("formation", "Place of a follower (kind = follow), kept by the leader's acoustic reports",
              [&](ConfigVisitor& formation) { visit_formation(formation, b.formation); });
  });
  with_kind(v, b, {Kind::kSeekLink}, [&] {
    v.section("search", "Receivers and depths of a vehicle that seeks a link (kind = seek_link)",
              [&](ConfigVisitor& search) { visit_search(search, b); });
  });
  if (!v.writing() && b.kind == BehaviourKind::kSeekLink) check_search(v, b);
  if (!v.writing() && b.kind == BehaviourKind::kWaypoints && b.waypoints.empty())
    v.problem("waypoints", "at least one point [north, east, down], with kind = waypoints");
}

void visit_behaviours(ConfigVisitor& v, PilotConfig& pilot) {
  v.list(
      "behaviour", "Behaviours, carried out one after another instead of the mission's waypoints",
      pilot.behaviours.size(), [&](std::size_t n) { pilot.behaviours.resize(n); },
      [&](ConfigVisitor& item, std::size_t i) { visit_behaviour(item, pilot.behaviours[i]); });
  if (!v.writing() && !pilot.behaviours.empty() && !pilot.mission.waypoints.empty())
    v.problem("waypoints", "none beside [[vehicle.mission.behaviour]]; give them to a behaviour");
}

void visit_navigator(ConfigVisitor& v, PilotConfig& pilot) {
  NavigatorRules& rules = pilot.navigator;
  v.number("log_drift_mps", rules.log_drift_mps,
           {0, 10, "m/s", "growth of the position's standard deviation without speed over ground: currents"});
  v.number("start_deviation_m", rules.start_deviation_m, {0, 1e4, "m", "standard deviation of the start"});
  v.advanced([&] {
    bus::degrees(v, "gyro_bias_degps", rules.gyro_bias_radps,
                 {0, 10, "deg/s", "largest bias of a gyro that replaces the compass"});
  });
  v.text("usbl_beacons", pilot.usbl_beacons, {},
         "names of vehicles that do not move, with spaces between, for fixes by bearings of their packets");
  v.when(!pilot.usbl_beacons.empty(), "usbl_beacons", [&] {
    v.number("sound_speed_mps", pilot.acoustic_fix.sound_speed_mps,
             {1300, 1700, "m/s", "mean sound speed, for ranges to usbl_beacons"});
  });
}

void visit_broadcast(ConfigVisitor& v, Broadcast& broadcast) {
  double period_s = broadcast.period.seconds(), start_s = broadcast.start.seconds();
  v.number("period_s", period_s, {0, 3600, "s", "time between reports of 17 bytes; 0: none"});
  v.when(period_s > 0, "period_s above 0", [&] {
    v.number("start_s", start_s, {0, 1e7, "s", "time of the first report, by the vehicle's clock"});
  });
  broadcast = {SimDuration::from_seconds(period_s), SimTime::from_seconds(start_s)};
}

const std::vector<std::string> kEnds{"loop", "hold", "stop", "surface"};
const std::vector<std::string> kSteerings{"fins", "thrusters", "buoyancy"};

// Visits the gains of the chosen steering. A glider's rudder uses the gains of fin steering.
void visit_control(ConfigVisitor& v, PilotConfig& pilot) {
  const auto with = [&](std::initializer_list<Steering> steerings, const std::function<void()>& body) {
    bus::when_one_of(v, "steering", pilot.steering, kSteerings, steerings, body);
  };
  v.advanced([&] {
    with({Steering::kFins, Steering::kBuoyancy}, [&] {
      v.section("gains", "Gains of steering by fins; the defaults suit torpedo and remus100-pvs",
                [&](ConfigVisitor& gains) { visit_gains(gains, pilot.gains); });
    });
    with({Steering::kThrusters}, [&] {
      v.section("hover_gains", "Gains of steering by thrusters; the defaults suit hover",
                [&](ConfigVisitor& gains) { visit_hover_gains(gains, pilot.hover_gains); });
    });
  });
  with({Steering::kBuoyancy}, [&] {
    v.section("glide", "Sawtooth of a glider (steering = buoyancy); the defaults suit the model glider",
              [&](ConfigVisitor& glide) { visit_glide(glide, pilot.glide); });
  });
}

void visit_mission(ConfigVisitor& v, PilotConfig& pilot) {
  Mission& m = pilot.mission;
  v.points("waypoints", m.waypoints,
           {-1e6, 1e6, "m",
            "north, east, down of each waypoint; without these and behaviours the vehicle is not piloted"});
  v.number("speed_mps", m.speed_mps, {0.01, 50, "m/s", "speed through the water"});
  bus::choice(
      v, "at_end", m.at_end, kEnds,
      "after the last waypoint: start again, circle it (with thrusters: stay at it), stop, or stop and rise "
      "by buoyancy engine and drop weight");
  v.number("acceptance_radius_m", m.acceptance_radius_m,
           {0.1, 1e4, "m", "horizontal distance at which a waypoint counts as reached"});
  bus::when_one_of(v, "at_end", m.at_end, kEnds, {AtEnd::kHold}, [&] {
    v.number("hold_radius_m", m.hold_radius_m, {1, 1e5, "m", "radius of the circle round the last waypoint"});
  });
  v.number("min_altitude_m", m.min_altitude_m,
           {0, 1000, "m", "least height above the seabed, within the altimeter's range"});
  bus::choice(v, "steering", pilot.steering, kSteerings,
              "actuators: propeller and fins, thrusters as of hover, or buoyancy, moving mass and rudder");
  bus::choice(v, "navigate_by", pilot.navigate_by, {"state", "sensors"},
              "source of its position: the true state, or dead reckoning by its own sensors");
  v.when(pilot.navigate_by == NavigateBy::kSensors, "navigate_by = \"sensors\"", [&] {
    v.section("navigator", "Dead reckoning (navigate_by = sensors) and its uncertainty",
              [&](ConfigVisitor& navigator) { visit_navigator(navigator, pilot); });
  });
  v.section("broadcast", "Position reports of a leader, sent by modem to its followers",
            [&](ConfigVisitor& broadcast) { visit_broadcast(broadcast, pilot.broadcast); });
  visit_control(v, pilot);
  visit_behaviours(v, pilot);
}

void visit_vehicle(ConfigVisitor& v, PilotConfig& pilot) {
  v.shared_with_others();
  v.text("name", pilot.vehicle, {}, "");
  bus::integer_as(v, "id", pilot.vehicle_id, {1, 2147483647, "", ""});
  v.vector3("start_ned_m", pilot.start_ned_m, {-1e6, 1e6, "m", ""});
  if (!v.given("mission")) return;
  v.section("mission", "Mission of the autopilot", [&](ConfigVisitor& m) { visit_mission(m, pilot); });
}

void check_leaders(ConfigVisitor& v, const AutopilotConfig& config) {
  for (const PilotConfig& follower : config.vehicles) {
    for (const Behaviour& behaviour : follower.behaviours) {
      const std::string& name = behaviour.formation.leader;
      if (behaviour.kind != BehaviourKind::kFollow || find_leader(config, name)) continue;
      v.problem("vehicle", "for the formation of " + follower.vehicle +
                               " a leader that broadcasts (broadcast.period_s above 0); given is '" + name +
                               "'");
    }
  }
}

void check_listeners(ConfigVisitor& v, const AutopilotConfig& config) {
  for (const PilotConfig& seeker : config.vehicles) {
    for (const Behaviour& behaviour : seeker.behaviours) {
      if (behaviour.kind != BehaviourKind::kSeekLink) continue;
      for (const std::string& name : listeners_of(behaviour.search)) {
        const auto listener = std::ranges::find(config.vehicles, name, &PilotConfig::vehicle);
        if (listener == config.vehicles.end() || name == seeker.vehicle)
          v.problem("vehicle", "for the search.listeners of " + seeker.vehicle +
                                   " other vehicles of the scenario; given is '" + name + "'");
      }
    }
  }
}

}  // namespace

std::map<std::int32_t, Vec3> beacons_of(const AutopilotConfig& config, const PilotConfig& pilot) {
  std::map<std::int32_t, Vec3> beacons;
  std::istringstream names(pilot.usbl_beacons);
  for (std::string name; names >> name;) {
    const auto found = std::ranges::find(config.vehicles, name, &PilotConfig::vehicle);
    require(found != config.vehicles.end() && name != pilot.vehicle,
            "vehicle " + pilot.vehicle + ": mission.navigator.usbl_beacons names '" + name +
                "'; allowed are other vehicles of the scenario, with spaces between");
    beacons[found->vehicle_id] = found->start_ned_m;
  }
  return beacons;
}

const PilotConfig* find_leader(const AutopilotConfig& config, const std::string& name) {
  for (const PilotConfig& vehicle : config.vehicles) {
    if (vehicle.vehicle == name && vehicle.broadcast.period > SimDuration()) return &vehicle;
  }
  return nullptr;
}

void visit(ConfigVisitor& v, AutopilotConfig& config) {
  v.section("autopilot", "Autopilot of the vehicles with a mission", [&](ConfigVisitor& section) {
    section.advanced([&] {
      bus::seconds(section, "state_timeout_s", config.state_timeout,
                   {0.01, 3600, "s", "age of a vehicle's state beyond which it is not steered"});
    });
    section.text("only_vehicle", config.only_vehicle, {},
                 "name of the only vehicle that is piloted; empty: all with a mission");
  });
  v.list(
      "vehicle", "A vehicle", config.vehicles.size(), [&](std::size_t n) { config.vehicles.resize(n); },
      [&](ConfigVisitor& item, std::size_t i) { visit_vehicle(item, config.vehicles[i]); });
  if (v.writing()) return;
  visit(v, config.clocks);
  check_leaders(v, config);
  check_listeners(v, config);
}

}  // namespace halocline::clients
