// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/pages/vehicle_json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/elementary.h"
#include "runs/timeline/timed_series.h"
#include "viewer/pages/plan_json.h"
#include "viewer/pages/run_json.h"

namespace halocline::monitor {
namespace {

using clients::Timed;
using clients::TimedSeries;
using nlohmann::json;
using Values = std::vector<Timed<double>>;

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegrees = 180 / std::numbers::pi;

class Panels {
 public:
  Panels(const TimeWindow& window, std::size_t max_points) : window_(window), max_points_(max_points) {}

  void begin(const char* key, const char* label, const char* unit, int digits, bool downward = false) {
    end();
    panel_ = {{"key", key},       {"label", label},       {"unit", unit},
              {"digits", digits}, {"downward", downward}, {"series", json::array()}};
  }

  // Adds a series. `value` returns NaN where the quantity does not exist.
  template <class Entry, class Value>
  void add(const char* label, const char* role, const TimedSeries<Entry>& series, const Value& value) {
    Values values;
    for (const auto& [at, entry] : series.between(window_.from, window_.to)) {
      const double number = value(entry);
      if (!std::isnan(number)) values.push_back({at, number});
    }
    if (values.empty()) return;
    json time_s = json::array(), shown = json::array();
    for (const auto& [at, number] : decimated(std::span<const Timed<double>>(values), max_points_,
                                              [](double number) { return number; })) {
      time_s.push_back(at.seconds());
      shown.push_back(number);
    }
    panel_["series"].push_back(
        {{"label", label}, {"role", role}, {"time_s", std::move(time_s)}, {"value", std::move(shown)}});
  }

  json take() {
    end();
    return std::move(panels_);
  }

 private:
  void end() {
    if (!panel_.is_null() && !panel_["series"].empty()) panels_.push_back(std::move(panel_));
    panel_ = json();
  }

  TimeWindow window_;
  std::size_t max_points_;
  json panel_, panels_ = json::array();
};

template <class Entry, class Field>
auto field(Field Entry::*member, double factor = 1) {
  return [member, factor](const Entry& entry) { return factor * static_cast<double>(entry.*member); };
}

// Returns a reader of a measurement that yields NaN in messages without a fresh one.
template <class Fresh>
auto reading(Fresh vehicle_sensors_t::*fresh, double vehicle_sensors_t::*member, double factor = 1) {
  return [fresh, member, factor](const vehicle_sensors_t& s) {
    return s.*fresh != 0 ? factor * s.*member : kMissing;
  };
}

double compass_deg(double angle_rad) {
  return angle_rad < 0 ? angle_rad * kDegrees + 360 : angle_rad * kDegrees;
}

void add_motion(Panels& panels, const clients::RunTimeline& timeline, const clients::VehicleRecord& vehicle) {
  using clients::TrackPoint;
  using Sensors = vehicle_sensors_t;
  using Status = autopilot_status_t;
  const double surface_m = timeline.scenario().sea_surface_z_m;
  const auto seabed_m = [&](const TrackPoint& p) {
    return timeline.seabed_m(p.position_ned_m.x(), p.position_ned_m.y());
  };
  panels.begin("depth", "Depth", "m", 1, /*downward=*/true);
  panels.add("actual", "actual", vehicle.track, [](const TrackPoint& p) { return p.position_ned_m.z(); });
  panels.add("measured", "measured", vehicle.sensors,
             [&](const Sensors& s) { return s.depth_fresh != 0 ? s.depth_m + surface_m : kMissing; });
  panels.add("seabed", "seabed", vehicle.track, seabed_m);
  panels.add("commanded", "commanded", vehicle.activity, [](const Status& s) { return s.commanded_z_m; });
  panels.begin("altitude", "Altitude", "m", 1);
  panels.add("actual", "actual", vehicle.track,
             [&](const TrackPoint& p) { return seabed_m(p) - p.position_ned_m.z(); });
  panels.add("measured", "measured", vehicle.sensors, [](const Sensors& s) {
    return s.altitude_status == Sensors::ALTITUDE_MEASURED ? s.altitude_m : kMissing;
  });
  panels.begin("speed", "Speed", "m/s", 2);
  panels.add("over ground", "actual", vehicle.track, field(&TrackPoint::speed_mps));
  panels.add("through the water", "measured", vehicle.sensors,
             reading(&Sensors::water_speed_fresh, &Sensors::water_speed_mps));
  panels.add("commanded", "commanded", vehicle.activity,
             [](const Status& s) { return s.is_propelled != 0 ? s.commanded_speed_mps : 0; });
  panels.begin("heading", "Heading", "°", 0);
  panels.add("actual", "actual", vehicle.track,
             [](const TrackPoint& p) { return compass_deg(p.attitude.yaw); });
  panels.add("commanded", "commanded", vehicle.activity, [](const Status& s) {
    return s.is_propelled != 0 ? compass_deg(s.commanded_course_rad) : kMissing;
  });
  panels.begin("pitch", "Pitch", "°", 1);
  panels.add("actual", "actual", vehicle.track,
             [](const TrackPoint& p) { return p.attitude.pitch * kDegrees; });
}

void add_actuators(Panels& panels, const clients::VehicleRecord& vehicle) {
  using Sensors = vehicle_sensors_t;
  using Command = vehicle_command_t;
  panels.begin("propeller", "Propeller", "rpm", 0);
  panels.add("actual", "actual", vehicle.sensors, field(&Sensors::shaft_rpm));
  panels.add("commanded", "commanded", vehicle.commands, field(&Command::propeller_rpm));
  panels.begin("rudder", "Rudder", "°", 1);
  panels.add("actual", "actual", vehicle.sensors, field(&Sensors::rudder_angle_rad, kDegrees));
  panels.add("commanded", "commanded", vehicle.commands, field(&Command::rudder_rad, kDegrees));
  panels.begin("stern_planes", "Stern planes", "°", 1);
  panels.add("actual", "actual", vehicle.sensors, field(&Sensors::stern_angle_rad, kDegrees));
  panels.add("commanded", "commanded", vehicle.commands, field(&Command::stern_plane_rad, kDegrees));
}

double horizontal_error_m(const position_estimate_t& estimate) {
  const bool is_known = estimate.truth_known != 0 && estimate.estimate_status != position_estimate_t::NONE;
  return is_known ? elementary::hypot(estimate.error_ned_m[0], estimate.error_ned_m[1]) : kMissing;
}

// Standard deviation of the horizontal position: sqrt(var_north + var_east), m.
double deviation_m(const position_estimate_t& estimate) {
  if (estimate.estimate_status == position_estimate_t::NONE) return kMissing;
  return std::sqrt(std::max(0.0, estimate.covariance_ned_m2[0] + estimate.covariance_ned_m2[4]));
}

json estimate_json(const clients::VehicleRecord& vehicle, const TimeWindow& window, std::size_t max_points) {
  std::vector<Timed<position_estimate_t>> known;
  for (const auto& entry : vehicle.estimates.between(window.from, window.to)) {
    if (entry.value.estimate_status != position_estimate_t::NONE) known.push_back(entry);
  }
  if (known.empty()) return nullptr;
  json shown;
  for (const char* member :
       {"time_s", "north_m", "east_m", "north_variance_m2", "covariance_m2", "east_variance_m2", "error_m"})
    shown[member] = json::array();
  for (const auto& [at, estimate] :
       decimated(std::span<const Timed<position_estimate_t>>(known), max_points, horizontal_error_m)) {
    shown["time_s"].push_back(at.seconds());
    shown["north_m"].push_back(estimate.position_ned_m[0]);
    shown["east_m"].push_back(estimate.position_ned_m[1]);
    shown["north_variance_m2"].push_back(estimate.covariance_ned_m2[0]);
    shown["covariance_m2"].push_back(estimate.covariance_ned_m2[1]);
    shown["east_variance_m2"].push_back(estimate.covariance_ned_m2[4]);
    shown["error_m"].push_back(horizontal_error_m(estimate));
  }
  return shown;
}

json faults_json(const clients::VehicleRecord& vehicle) {
  json all = json::array();
  for (const auto& [at, fault] : vehicle.faults) {
    const std::string label = fault_text(fault);
    for (json& other : all) {
      const bool same = other["kind"] == fault.fault_kind && other["sensor"] == fault.dead_sensor;
      if (same && other["end_s"].is_null()) other["end_s"] = at.seconds();
    }
    if (fault.fault_fixed == 0)
      all.push_back({{"begin_s", at.seconds()},
                     {"end_s", nullptr},
                     {"label", label},
                     {"kind", fault.fault_kind},
                     {"sensor", fault.dead_sensor}});
  }
  return all;
}

json safe_states_json(const clients::VehicleRecord& vehicle, const TimeWindow& window) {
  json all = json::array();
  bool is_safe = false;
  for (const auto& [at, sensors] : vehicle.sensors.between(window.from, window.to)) {
    if (is_safe && sensors.safe_state == 0) all.back()["end_s"] = at.seconds();
    if (!is_safe && sensors.safe_state != 0) all.push_back({{"begin_s", at.seconds()}, {"end_s", nullptr}});
    is_safe = sensors.safe_state != 0;
  }
  return all;
}

}  // namespace

json vehicle_series_json(const clients::RunTimeline& timeline, const clients::VehicleRecord& vehicle,
                         const TimeWindow& window, std::size_t max_points) {
  Panels panels(window, max_points);
  add_motion(panels, timeline, vehicle);
  add_actuators(panels, vehicle);
  panels.begin("error", "Error of the estimate", "m", 1);
  panels.add("error", "actual", vehicle.estimates, horizontal_error_m);
  panels.add("one standard deviation", "estimate", vehicle.estimates, deviation_m);
  return {{"vehicle", vehicle.index},
          {"panels", panels.take()},
          {"estimate", estimate_json(vehicle, window, max_points)},
          {"faults", faults_json(vehicle)},
          {"activities", activities_json(vehicle, window)},
          {"safe_state", safe_states_json(vehicle, window)}};
}

json tracks_json(const clients::RunTimeline& timeline, const TimeWindow& window, std::size_t max_points) {
  json tracks = json::array();
  for (const clients::VehicleRecord& vehicle : timeline.vehicles()) {
    json time_s = json::array(), north_m = json::array(), east_m = json::array(), down_m = json::array();
    for (const auto& [at, point] : decimated_track(vehicle.track, window.from, window.to, max_points)) {
      time_s.push_back(at.seconds());
      north_m.push_back(point.position_ned_m.x());
      east_m.push_back(point.position_ned_m.y());
      down_m.push_back(point.position_ned_m.z());
    }
    tracks.push_back({{"vehicle", vehicle.index},
                      {"time_s", std::move(time_s)},
                      {"north_m", std::move(north_m)},
                      {"east_m", std::move(east_m)},
                      {"down_m", std::move(down_m)}});
  }
  return {{"tracks", std::move(tracks)}};
}

}  // namespace halocline::monitor
