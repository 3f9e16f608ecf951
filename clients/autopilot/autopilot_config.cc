#include "clients/autopilot/autopilot_config.h"

namespace halocline::clients {
namespace {

using bus::ConfigVisitor;

void visit_gains(ConfigVisitor& v, Gains& g) {
  v.number("heading_p", g.heading_p, {0, 100, "", "rad of rudder per rad of heading"});
  v.number("heading_d_s", g.heading_d_s, {0, 100, "s", "rad of rudder per rad/s of yaw rate"});
  v.number("depth_p_rad_per_m", g.depth_p_rad_per_m, {0, 10, "rad/m", "pitch per metre of depth error"});
  v.number("depth_i_rad_per_m_s", g.depth_i_rad_per_m_s,
           {0, 10, "rad/(m s)", "pitch per metre and second of depth error"});
  v.number("pitch_p", g.pitch_p, {0, 100, "", "rad of stern plane per rad of pitch"});
  v.number("pitch_d_s", g.pitch_d_s, {0, 100, "s", "rad of stern plane per rad/s of pitch rate"});
  v.number("speed_feed_forward_rpm_s_per_m", g.speed_feed_forward_rpm_s_per_m,
           {0, 1e5, "rpm s/m", "propeller speed per m/s asked for"});
  v.number("speed_p_rpm_s_per_m", g.speed_p_rpm_s_per_m,
           {0, 1e5, "rpm s/m", "propeller speed per m/s of speed error"});
  v.number("speed_i_rpm_per_m", g.speed_i_rpm_per_m,
           {0, 1e5, "rpm/m", "propeller speed per metre of the speed error's integral"});
  degrees(v, "max_pitch_deg", g.max_pitch_rad, {0, 60, "deg", "greatest pitch asked for"});
  degrees(v, "max_fin_deg", g.max_fin_rad, {0, 90, "deg", "greatest rudder and stern plane asked for"});
  v.number("max_rpm", g.max_rpm, {0, 1e5, "rpm", "greatest propeller speed asked for"});
}

void visit_hover_gains(ConfigVisitor& v, HoverGains& g) {
  v.number("position_p_n_per_m", g.position_p_n_per_m, {0.01, 1e5, "N/m", "push per metre of distance"});
  v.number("position_i_n_per_m_s", g.position_i_n_per_m_s, {0, 1e5, "N/(m s)", "push per metre and second"});
  v.number("position_d_n_s_per_m", g.position_d_n_s_per_m,
           {0, 1e6, "N s/m", "push against the speed over ground"});
  v.number("heading_p_nm", g.heading_p_nm, {0, 1e6, "N m", "moment per rad of heading"});
  v.number("heading_d_nm_s", g.heading_d_nm_s, {0, 1e6, "N m s", "moment per rad/s of yaw rate"});
  v.number("depth_p_n_per_m", g.depth_p_n_per_m, {0.01, 1e5, "N/m", "push per metre of depth"});
  v.number("depth_i_n_per_m_s", g.depth_i_n_per_m_s,
           {0, 1e5, "N/(m s)", "push per metre and second of depth"});
  v.number("depth_d_n_s_per_m", g.depth_d_n_s_per_m, {0, 1e6, "N s/m", "push against the vertical speed"});
  v.number("pitch_p_nm", g.pitch_p_nm, {0, 1e6, "N m", "moment per rad of pitch"});
  v.number("pitch_d_nm_s", g.pitch_d_nm_s, {0, 1e6, "N m s", "moment per rad/s of pitch rate"});
  v.number("least_force_n", g.least_force_n, {0, 1e5, "N", "push below which the heading is kept"});
  v.number("beside_axis_m", g.beside_axis_m, {0.01, 100, "m", "of the horizontal thrusters"});
  v.number("from_middle_m", g.from_middle_m, {0.01, 100, "m", "of the vertical thrusters"});
  v.number("full_thrust_n", g.full_thrust_n, {0.01, 1e6, "N", "of a thruster at full_rpm"});
  v.number("astern_ratio", g.astern_ratio, {0.01, 1, "", "of its thrust astern"});
  v.number("full_rpm", g.full_rpm, {1, 1e5, "rpm", "greatest speed of a thruster"});
}

void visit_mission(ConfigVisitor& v, PilotConfig& pilot) {
  Mission& m = pilot.mission;
  v.points("waypoints", m.waypoints,
           {-1e6, 1e6, "m", "north, east, down of each waypoint; none: the vehicle is not piloted"});
  v.number("speed_mps", m.speed_mps, {0.01, 50, "m/s", "speed through the water"});
  bus::choice(
      v, "at_end", m.at_end, {"loop", "hold", "stop"},
      "after the last waypoint: start again, circle it (with thrusters: stay at it), or stop the propeller");
  v.number("acceptance_radius_m", m.acceptance_radius_m,
           {0.1, 1e4, "m", "horizontal distance at which a waypoint counts as reached"});
  v.number("hold_radius_m", m.hold_radius_m, {1, 1e5, "m", "radius of the circle round the last waypoint"});
  v.number("lookahead_m", m.lookahead_m, {0.1, 1e4, "m", "how far ahead on the leg the vehicle aims"});
  v.number("min_altitude_m", m.min_altitude_m,
           {0, 1000, "m", "least height above the seabed, where the altimeter sees it"});
  bus::choice(v, "steering", pilot.steering, {"fins", "thrusters"},
              "what steers it: propeller and fins, or four thrusters as hover has them");
  v.section("gains", "Gains with fins; the defaults suit torpedo and remus100-pvs",
            [&](ConfigVisitor& gains) { visit_gains(gains, pilot.gains); });
  v.section("hover_gains", "Gains with thrusters; the defaults suit hover",
            [&](ConfigVisitor& gains) { visit_hover_gains(gains, pilot.hover_gains); });
}

void visit_vehicle(ConfigVisitor& v, PilotConfig& pilot) {
  v.shared_with_others();
  v.text("name", pilot.vehicle, {}, "");
  bus::integer_as(v, "id", pilot.vehicle_id, {1, 2147483647, "", ""});
  if (!v.given("mission")) return;
  v.section("mission", "What the autopilot does with this vehicle",
            [&](ConfigVisitor& mission) { visit_mission(mission, pilot); });
}

}  // namespace

void visit(ConfigVisitor& v, AutopilotConfig& config) {
  v.section("autopilot", "The pilots of all vehicles with a mission", [&](ConfigVisitor& section) {
    bus::seconds(section, "command_period_s", config.command_period,
                 {0.001, 10, "s", "simulated time between commands"});
    bus::seconds(section, "state_timeout_s", config.state_timeout,
                 {0.01, 3600, "s", "age of a vehicle's state beyond which it is not steered"});
    section.text("only_vehicle", config.only_vehicle, {}, "pilot only this one; empty: all with a mission");
  });
  v.list(
      "vehicle", "A vehicle", config.vehicles.size(), [&](std::size_t n) { config.vehicles.resize(n); },
      [&](ConfigVisitor& item, std::size_t i) { visit_vehicle(item, config.vehicles[i]); });
}

}  // namespace halocline::clients
