// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/sensor_config.h"

#include <functional>
#include <initializer_list>
#include <numbers>
#include <string_view>

#include "vehicle_sim/sensors/sensor_errors.h"

namespace halocline::vehicle_sim {
namespace {

using bus::ConfigVisitor;
using bus::NumberRule;

// Unit of a sensor's keys, and its size in the unit of the struct.
struct Unit {
  std::string key;      // suffix of the keys
  std::string meaning;  // unit in words
  double si = 1;
  double greatest = 1e4;
};

constexpr double kDegree = std::numbers::pi / 180;
const Unit kMetres{"m", "m", 1, 1e4}, kMetresPerSecond{"mps", "m/s", 1, 100},
    kDegrees{"deg", "deg", kDegree, 180}, kDegreesPerSecond{"degps", "deg/s", kDegree, 360};
const NumberRule kPlace{-1e3, 1e3, "m",
                        "place of the instrument: forward, starboard, down of the hull's middle"};

void number_of(ConfigVisitor& v, const std::string& key, double& value, double si, const NumberRule& rule) {
  if (si == 1) return v.number(key, value, rule);
  bus::degrees(v, key, value, rule);
}

void visit_noise(ConfigVisitor& v, SensorErrors& e, const Unit& unit) {
  number_of(v, "noise_" + unit.key, e.noise, unit.si,
            {0, unit.greatest, unit.meaning, "standard deviation of each sample"});
  number_of(v, "bias_" + unit.key, e.bias, unit.si,
            {-unit.greatest, unit.greatest, unit.meaning, "constant error"});
  v.number("dropout_probability", e.dropout, {0, 1, "", "probability that a sample is missing"});
}

void visit_errors(ConfigVisitor& v, SensorErrors& e, const Unit& unit) {
  visit_noise(v, e, unit);
  const std::string meaning = unit.meaning + "/sqrt(s)";
  v.advanced([&] {
    number_of(v, "bias_walk_" + unit.key + "_per_sqrt_s", e.walk, unit.si,
              {0, unit.greatest, meaning, "random walk of the bias: after t seconds this times sqrt(t)"});
  });
}

// Visits the rate of a sensor. A rate of 0 Hz in the file is a period of 0.
void visit_rate(ConfigVisitor& v, SimDuration& period, double max_hz, std::string_view meaning) {
  double rate_hz = period > SimDuration() ? 1 / period.seconds() : 0;
  v.number("rate_hz", rate_hz, {0, max_hz, "Hz", meaning});
  if (rate_hz > 0 && rate_hz < 0.001) return v.problem("rate_hz", "allowed is 0, or 0.001 Hz and more");
  period = rate_hz > 0 ? SimDuration::from_seconds(1 / rate_hz) : SimDuration();
}

void visit_basic(ConfigVisitor& v, BasicSensor& sensor, const Unit& unit) {
  visit_rate(v, sensor.period, 50, "measurements a second; 0: at each SENSORS");
  visit_errors(v, sensor.errors, unit);
}

constexpr std::string_view kWorking = "rate_hz above 0";

void visit_beams(ConfigVisitor& v, DvlSettings& dvl) {
  bus::degrees(v, "beam_angle_deg", dvl.beam_angle_rad,
               {1, 80, "deg", "angle of each beam from the instrument's down axis"});
  v.number("range_noise_m", dvl.range_noise_m, {0, 1e3, "m", "standard deviation of a beam's range"});
  v.vector3("place_m", dvl.place_m, kPlace);
  bus::degrees(v, "misalignment_deg", dvl.misalignment_rad,
               {-90, 90, "deg", "uncorrected rotation of the instrument about down"});
}

void visit_working_dvl(ConfigVisitor& v, DvlSettings& dvl) {
  v.number("range_m", dvl.range_m, {0.1, 1e4, "m", "maximum range along a beam"});
  visit_errors(v, dvl.errors, kMetresPerSecond);
  v.number("scale_error", dvl.scale_error, {-0.5, 0.5, "", "relative error of speeds; 0.01: 1 % too much"});
  v.advanced([&] { visit_beams(v, dvl); });
}

void visit_dvl(ConfigVisitor& v, DvlSettings& dvl) {
  visit_rate(v, dvl.period, 50, "pings a second; 0: no Doppler log");
  v.when(dvl.period > SimDuration(), kWorking, [&] { visit_working_dvl(v, dvl); });
}

void visit_gps(ConfigVisitor& v, GpsSettings& gps) {
  visit_rate(v, gps.period, 50, "fixes a second at the surface; 0: no GPS");
  v.when(gps.period > SimDuration(), kWorking, [&] {
    v.number("max_depth_m", gps.max_depth_m, {-10, 10, "m", "maximum depth of the antenna for a fix"});
    visit_noise(v, gps.errors, kMetres);
    v.advanced([&] { v.vector3("place_m", gps.place_m, kPlace); });
  });
}

void visit_sonar(ConfigVisitor& v, SonarSettings& sonar) {
  visit_rate(v, sonar.period, 50, "fans a second; 0: no sonar");
  v.when(sonar.period > SimDuration(), kWorking, [&] {
    bus::integer_as(v, "rays", sonar.rays, {1, 512, "", "number of rays of a fan"});
    bus::degrees(v, "sector_deg", sonar.sector_rad, {0, 360, "deg", "angle from the first ray to the last"});
    bus::degrees(v, "tilt_deg", sonar.tilt_rad, {-90, 90, "deg", "angle of the fan below the forward axis"});
    v.number("range_m", sonar.range_m, {0.1, 1e4, "m", "maximum range of a ray"});
    visit_noise(v, sonar.errors, kMetres);
    v.advanced([&] { v.vector3("place_m", sonar.place_m, kPlace); });
  });
}

void visit_usbl(ConfigVisitor& v, UsblSettings& usbl) {
  v.boolean("fitted", usbl.fitted, "true: bearings of received packets are measured");
  v.when(usbl.fitted, "fitted = true", [&] { visit_noise(v, usbl.errors, kDegrees); });
}

const std::vector<std::string> kFaultKinds{"stuck-rudder", "stuck-stern-planes", "lost-propeller",
                                           "leak",         "dead-sensor",        "empty-battery"};

void visit_damage(ConfigVisitor& v, Fault& f) {
  const auto with = [&](std::initializer_list<FaultKind> kinds, const std::function<void()>& body) {
    bus::when_one_of(v, "kind", f.kind, kFaultKinds, kinds, body);
  };
  with({FaultKind::kStuckRudder, FaultKind::kStuckSternPlanes}, [&] {
    if (v.writing() ? !f.angle_rad.has_value() : !v.given("angle_deg")) return;
    double angle_rad = f.angle_rad.value_or(0);
    bus::degrees(v, "angle_deg", angle_rad, {-90, 90, "deg", "angle of stuck fins; not given: as they are"});
    f.angle_rad = angle_rad;
  });
  with({FaultKind::kLeak}, [&] {
    v.number("leak_kg_per_s", f.leak_rate_kg_s, {-100, 100, "kg/s", "rate of a leak; below 0 pumps out"});
    v.number("leak_volume_m3", f.leak_volume_m3, {0, 100, "m^3", "maximum volume of water inside"});
  });
  with({FaultKind::kDeadSensor},
       [&] { bus::choice(v, "sensor", f.sensor, bus::names_of(kSensorKinds), "sensor that fails"); });
}

void visit_fault(ConfigVisitor& v, FaultEntry& entry) {
  Fault& f = entry.fault;
  double at_s = (f.from - SimTime()).seconds(), until_s = (entry.until - SimTime()).seconds();
  v.text("vehicle", entry.vehicle, {}, "name of a vehicle that the vehicle simulator moves or holds");
  bus::choice(v, "kind", f.kind, kFaultKinds, "kind of fault");
  v.number("at_s", at_s, {0, 1e7, "s", "simulation time at which the fault begins"});
  v.number("until_s", until_s, {0, 1e7, "s", "simulation time at which it is repaired; 0: never"});
  if (until_s > 0 && until_s <= at_s) v.problem("until_s", "allowed is 0, or a time after at_s");
  f.from = SimTime::from_seconds(at_s);
  entry.until = SimTime::from_seconds(until_s);
  visit_damage(v, f);
}

}  // namespace

void visit(ConfigVisitor& v, SensorSettings& s) {
  const auto basic = [&](std::string_view key, std::string_view meaning, BasicSensor& sensor,
                         const Unit& unit) {
    v.section(key, meaning, [&](ConfigVisitor& section) { visit_basic(section, sensor, unit); });
  };
  basic("depth", "Depth sensor: depth below the surface", s.depth, kMetres);
  basic("altimeter", "Altimeter: height above the seabed", s.altimeter, kMetres);
  basic("log", "Speed log: forward speed through the water", s.log, kMetresPerSecond);
  v.section("compass", "Compass: heading, pitch and roll", [&](ConfigVisitor& section) {
    visit_basic(section, s.compass, kDegrees);
    section.advanced([&] {
      bus::degrees(section, "tilt_noise_deg", s.tilt_noise_rad,
                   {0, 90, "deg", "standard deviation of pitch and roll; noise_deg is that of the heading"});
    });
  });
  basic("gyro", "Gyro: angular rates about the vehicle's axes", s.gyro, kDegreesPerSecond);
  v.section("dvl", "Doppler log of four beams", [&](ConfigVisitor& section) { visit_dvl(section, s.dvl); });
  v.section("gps", "GPS: fixes at the surface", [&](ConfigVisitor& section) { visit_gps(section, s.gps); });
  v.section("sonar", "Forward sonar: a fan of rays to the seabed",
            [&](ConfigVisitor& section) { visit_sonar(section, s.sonar); });
  v.section("usbl", "USBL array of the modem: bearings of received packets",
            [&](ConfigVisitor& section) { visit_usbl(section, s.usbl); });
}

void visit_faults(ConfigVisitor& v, std::vector<FaultEntry>& faults) {
  v.list(
      "fault", "Fault of a vehicle", faults.size(), [&](std::size_t n) { faults.resize(n); },
      [&](ConfigVisitor& item, std::size_t i) { visit_fault(item, faults[i]); });
}

}  // namespace halocline::vehicle_sim
