// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/model_config.h"

#include <string_view>
#include <vector>

#include "bus/config/carried_files.h"
#include "core/check.h"
#include "vehicle_sim/dynamics/actuators.h"
#include "vehicle_sim/model_library.h"
#include "vehicle_sim/sensor_config.h"

namespace halocline::vehicle_sim {
namespace {

using bus::ConfigVisitor;
using bus::NumberRule;

constexpr double kMax = 1e9;  // limit of parameters without a natural bound

// Visits six numbers, surge to yaw.
void visit_six(ConfigVisitor& v, std::string_view key, Vec6& values, const NumberRule& rule) {
  std::vector<double> list(values.data(), values.data() + 6);
  v.numbers(key, list, rule);
  if (list.size() != 6) return v.problem(key, "six numbers are needed: surge, sway, heave, roll, pitch, yaw");
  values = Vec6(list.data());
}

// Visits a matrix by its diagonal and, where they are not zero, the elements right of it, row by row.
template <class Matrix>
void visit_symmetric(ConfigVisitor& v, const std::string& key, Matrix& m, double lowest_on_diagonal,
                     std::string_view unit, const std::string& meaning) {
  constexpr int n = Matrix::RowsAtCompileTime;
  std::vector<double> diagonal, right;
  for (int i = 0; i < n; ++i) {
    diagonal.push_back(m(i, i));
    for (int j = i + 1; j < n; ++j) right.push_back(m(i, j));
  }
  const std::size_t full = right.size();
  if (m.isDiagonal(0)) right.clear();
  v.numbers(key, diagonal, {lowest_on_diagonal, kMax, unit, meaning});
  const std::string right_key = key + "_off_diagonal";
  v.numbers(right_key, right, {-kMax, kMax, unit, "right of the diagonal, row by row; empty: all 0"});
  if (diagonal.size() != std::size_t{n})
    return v.problem(key, "as many numbers as degrees of freedom are needed");
  if (!right.empty() && right.size() != full) return v.problem(right_key, "all of them or none are needed");
  m.setZero();
  std::size_t next = 0;
  for (int i = 0; i < n; ++i) {
    m(i, i) = diagonal[static_cast<std::size_t>(i)];
    for (int j = i + 1; j < n && !right.empty(); ++j) m(i, j) = m(j, i) = right[next++];
  }
}

void visit_body(ConfigVisitor& v, ModelParameters& p) {
  v.number("length_m", p.hull.length_m,
           {0.01, 1000, "m", "of the hull, a spheroid for contact and at the surface"});
  v.number("diameter_m", p.hull.diameter_m, {0.001, 1000, "m", "of the hull, at most its length"});
  v.number("mass_kg", p.mass_kg, {1e-3, kMax, "kg", "dry mass"});
  bus::choice(v, "sea_surface", p.sea_surface, {"still", "waves"},
              "what it floats on: the still surface, or that of the waves");
  v.number("buoyancy_n", p.buoyancy_n, {0, kMax, "N", "of the whole hull under water, without its floats"});
  v.vector3("center_of_gravity_m", p.center_of_gravity_m, {-1000, 1000, "m", "from the hull's middle"});
  v.vector3("center_of_buoyancy_m", p.center_of_buoyancy_m, {-1000, 1000, "m", "from the hull's middle"});
  v.vector3("leak_offset_m", p.leak_offset_m,
            {-1000, 1000, "m", "where the water of a leak gathers, from the centre of gravity"});
  v.vector3("transducer_m", p.transducer_m,
            {-1000, 1000, "m", "of the modem, from the hull's middle: what STATE gives the place of"});
  visit_symmetric(v, "inertia_kg_m2", p.inertia_kg_m2, 1e-9, "kg m^2",
                  "about the centre of gravity: roll, pitch, yaw");
  visit_symmetric(v, "added_mass", p.added_mass, 0, "kg; kg m^2", "about the hull's middle: surge to yaw");
  bus::choice(v, "added_mass_coriolis", p.added_mass_coriolis, {"full", "roll-only"},
              "full: with Munk moments; roll-only: what remus100-pvs keeps");
  bus::choice(v, "current_treatment", p.current_treatment, {"upstream", "galilean"},
              "how a current acts: as published with remus100-pvs, or exactly");
}

void visit_damping(ConfigVisitor& v, Damping& d) {
  visit_six(v, "linear", d.linear, {0, kMax, "N s/m; N m s", "surge to yaw, at rest"});
  visit_six(v, "decay_s_per_m", d.decay_s_per_m,
            {0, 1000, "s/m", "each falls with speed U as exp(-decay U)"});
}

constexpr std::string_view kWithArea = "reference_area_m2 above 0";

void visit_lift_coefficients(ConfigVisitor& v, LiftDrag& l) {
  v.number("zero_lift_drag", l.zero_lift_drag, {0, 1000, "", "drag coefficient at no angle"});
  v.number("lift_slope_per_rad", l.lift_slope_per_rad, {0, 1000, "1/rad", "of the angle of attack"});
  v.number("aspect_ratio", l.aspect_ratio, {1e-6, 1000, "", "for the induced drag"});
  v.number("oswald_efficiency", l.oswald_efficiency, {1e-6, 1, "", "for the induced drag"});
  bus::choice(v, "law", l.law, {"angle", "bounded"},
              "of the angle itself, jumping in reverse flow, or bounded and smooth at every angle");
  v.when(l.law == LiftLaw::kBounded, "law = \"bounded\"", [&] {
    v.number("x_m", l.x_m, {-1000, 1000, "m", "bounded: where it acts on the axis, negative aft"});
    v.number("broadside_drag", l.broadside_drag,
             {0, 1000, "", "bounded: drag coefficient added straight across; 0: by the induced drag's law"});
  });
}

void visit_lift_drag(ConfigVisitor& v, LiftDrag& l) {
  v.number("reference_area_m2", l.reference_area_m2, {0, kMax, "m^2", "0: the effect is absent"});
  v.when(l.reference_area_m2 > 0, kWithArea, [&] { visit_lift_coefficients(v, l); });
}

void visit_body_lift(ConfigVisitor& v, BodyLift& b) {
  v.number("reference_area_m2", b.reference_area_m2, {0, kMax, "m^2", "0: the effect is absent"});
  v.when(b.reference_area_m2 > 0, kWithArea, [&] {
    v.number("axial_drag", b.axial_drag, {0, 1000, "", "drag coefficient along the hull"});
    v.number("lift_slope_per_rad", b.lift_slope_per_rad, {0, 1000, "1/rad", "of sin(angle) cos(angle)"});
    v.number("center_aft_m", b.center_aft_m,
             {0, 1000, "m", "where the lift acts, behind the hull's middle as it moves"});
  });
}

void visit_cross_flow(ConfigVisitor& v, CrossFlow& c) {
  v.number("drag_coefficient", c.drag_coefficient, {0, 1000, "", "of the section across the flow"});
  v.number("strip_length_m", c.strip_length_m, {0, 1000, "m", "of each strip"});
  bus::integer_as(v, "strips", c.strips, {0, 1000, "", "number of strips, symmetric about the middle"});
  bus::choice(v, "planes", c.planes, {"sway", "both"}, "sway alone, or sway and heave together");
}

void visit_fins(ConfigVisitor& v, FinPair& f) {
  v.number("area_m2", f.area_m2, {0, kMax, "m^2", "of the pair; 0: there is none"});
  v.number("lift_slope_per_rad", f.lift_slope_per_rad, {0, 1000, "1/rad", "of the angle"});
  v.number("x_m", f.x_m, {-1000, 1000, "m", "place on the axis, negative aft of the hull's middle"});
  bus::choice(v, "law", f.law, {"deflection", "local-flow"},
              "force of the deflection alone, or of the flow at the fin");
  v.when(f.law == FinLaw::kLocalFlow, "law = \"local-flow\"", [&] {
    v.number("normal_drag", f.normal_drag, {0, 1000, "", "local-flow: drag coefficient straight across"});
  });
}

void visit_thruster(ConfigVisitor& v, Thruster& t) {
  v.vector3("position_m", t.position_m, {-1000, 1000, "m", "from the hull's middle"});
  v.vector3("direction", t.direction, {-1, 1, "", "of the push at positive speed, unit"});
  v.number("diameter_m", t.diameter_m, {0, 1000, "m", "0: there is none"});
  bus::choice(v, "inflow", t.inflow, {"speed", "axial"},
              "the vehicle's speed, or the water's along the shaft");
  v.number("advance_speed_ratio", t.advance_speed_ratio, {0, 1000, "", "1 - wake fraction"});
  v.number("thrust_at_rest", t.thrust_at_rest, {-1000, 1000, "", "K_T at no advance"});
  v.number("thrust_at_max", t.thrust_at_max, {-1000, 1000, "", "K_T at advance_max"});
  v.number("torque_at_rest", t.torque_at_rest, {-1000, 1000, "", "K_Q at no advance"});
  v.number("torque_at_max", t.torque_at_max, {-1000, 1000, "", "K_Q at advance_max"});
  v.number("advance_max", t.advance_max, {1e-6, 1000, "", "advance number of the second pair"});
  v.number("thrust_share", t.thrust_share, {0, 1, "", "1 - thrust deduction"});
  v.number("torque_share", t.torque_share, {-1, 1, "", "of the shaft's torque that turns the hull"});
  v.number("astern_ratio", t.astern_ratio, {0, 1, "", "K_T at rest astern over that ahead"});
  v.number("lag_s", t.lag_s, {1e-3, 1000, "s", "of the speed after its command, first order"});
  v.number("max_hz", t.max_hz, {0, 1e5, "1/s", "greatest speed, turns a second"});
}

void visit_fin_servo(ConfigVisitor& v, FinServo& s) {
  v.number("lag_s", s.lag_s, {1e-3, 1000, "s", "of the angle after its command, first order"});
  bus::degrees(v, "max_angle_deg", s.max_angle_rad, {0, 90, "deg", "greatest deflection either way"});
}

void visit_float(ConfigVisitor& v, Float& f) {
  v.vector3("bottom_m", f.bottom_m, {-1000, 1000, "m", "middle of its bottom, from the hull's middle"});
  v.number("length_m", f.length_m, {0.001, 1000, "m", "along the hull"});
  v.number("beam_m", f.beam_m, {0.001, 1000, "m", "across"});
  v.number("height_m", f.height_m, {0.001, 1000, "m", "from its bottom up"});
}

void visit_slow(ConfigVisitor& v, SlowActuator& a, const std::string& limit_key, const std::string& unit) {
  v.number(limit_key, a.limit, {0, 1000, unit, "greatest set point either way"});
  v.number("rate_" + unit + "_per_s", a.rate, {0, 1000, unit + "/s", "greatest rate"});
  v.number("lag_s", a.lag_s, {1e-3, 1000, "s", "behind its command, first order, where that is slower"});
}

void visit_ballast(ConfigVisitor& v, ModelParameters& p) {
  v.section("buoyancy_engine", "A bladder that changes the volume at constant mass", [&](ConfigVisitor& s) {
    visit_slow(s, p.buoyancy_engine.pump, "max_volume_m3", "m3");
    s.vector3("position_m", p.buoyancy_engine.position_m, {-1000, 1000, "m", "from the hull's middle"});
  });
  v.section("moving_mass", "A part of the mass that is driven along the hull", [&](ConfigVisitor& s) {
    s.number("mass_kg", p.moving_mass.mass_kg, {0, kMax, "kg", "of the body's; 0: there is none"});
    visit_slow(s, p.moving_mass.drive, "max_offset_m", "m");
  });
  v.section("drop_weight", "A part of the body that can be dropped", [&](ConfigVisitor& s) {
    s.number("mass_kg", p.drop_weight.mass_kg, {0, kMax, "kg", "of the body's; 0: there is none"});
    s.number("buoyancy_n", p.drop_weight.buoyancy_n, {0, kMax, "N", "its own, of the body's"});
    s.vector3("position_m", p.drop_weight.position_m, {-1000, 1000, "m", "from the hull's middle"});
  });
}

// Checks combinations of values, which rules on single keys cannot.
void check_as_a_whole(ConfigVisitor& v, const ModelParameters& p) {
  try {
    const Model model(p);
  } catch (const InvalidArgument& error) {
    v.problem("name", std::string("the vehicle as a whole is impossible: ") + error.what());
  }
}

void visit_whole(ConfigVisitor& v, ModelFile& model) {
  visit(v, model.parameters);
  if (v.writing() ? !model.sensors.has_value() : !v.given("sensors")) return;
  if (!model.sensors) model.sensors.emplace();
  v.section("sensors", "What it carries, where no scenario sets it",
            [&](ConfigVisitor& section) { visit(section, *model.sensors); });
}

ModelFile read_model(bus::ConfigFile& file) {
  ModelFile model;
  file.read([&](ConfigVisitor& v) {
    std::string base;
    v.text("based_on", base, built_in_models(), "a built-in model to start from");
    if (is_built_in(base)) model = load_model(base);
    visit_whole(v, model);
  });
  file.check(/*whole_file=*/true);
  file.read([&](ConfigVisitor& v) { check_as_a_whole(v, model.parameters); });
  file.check(/*whole_file=*/true);
  return model;
}

}  // namespace

void visit(ConfigVisitor& v, ModelParameters& p) {
  v.text("name", p.name, {}, "what it is called");
  v.number("water_density_kg_m3", p.water_density_kg_m3,
           {1, 1e5, "kg/m^3", "of the water that the coefficients mean"});
  v.number("gravity_m_s2", p.gravity_m_s2, {0.1, 100, "m/s^2", "acceleration of free fall"});
  v.section("body", "Mass, shape and added mass", [&](ConfigVisitor& s) { visit_body(s, p); });
  v.section("damping", "Linear damping", [&](ConfigVisitor& s) { visit_damping(s, p.damping); });
  v.section("lift_drag", "Lift and drag of hull and wings in the vertical plane, of the angle of attack",
            [&](ConfigVisitor& s) { visit_lift_drag(s, p.lift_drag); });
  v.section("body_lift", "Drag along the hull and lift across it, bounded at every angle",
            [&](ConfigVisitor& s) { visit_body_lift(s, p.body_lift); });
  v.section("cross_flow", "Drag of the flow across the hull, by strips",
            [&](ConfigVisitor& s) { visit_cross_flow(s, p.cross_flow); });
  v.section("rudder", "The upright pair of fins", [&](ConfigVisitor& s) { visit_fins(s, p.rudder); });
  v.section("stern_planes", "The level pair of fins",
            [&](ConfigVisitor& s) { visit_fins(s, p.stern_planes); });
  v.section("fin_servo", "What moves the fins", [&](ConfigVisitor& s) { visit_fin_servo(s, p.fin_servo); });
  v.section("propeller", "The propeller at the stern",
            [&](ConfigVisitor& s) { visit_thruster(s, p.propeller); });
  v.list(
      "thruster", "Thrusters, in the order of thruster_rpm", p.thrusters.size(),
      [&](std::size_t n) { p.thrusters.resize(n); },
      [&](ConfigVisitor& s, std::size_t i) { visit_thruster(s, p.thrusters[i]); });
  v.list(
      "float", "Upright elliptic cylinders that pierce the surface", p.floats.size(),
      [&](std::size_t n) { p.floats.resize(n); },
      [&](ConfigVisitor& s, std::size_t i) { visit_float(s, p.floats[i]); });
  visit_ballast(v, p);
}

bool names_a_model_file(const FilePath& model) {
  return bus::names_a_file(model.place(), bus::FileNames::kShipped);
}

ModelFile load_model(const FilePath& file_or_name) {
  const std::string& model = file_or_name.place();
  if (!names_a_model_file(file_or_name)) {
    std::string names;
    for (const std::string& name : built_in_models()) names += name + ", ";
    require(is_built_in(model),
            "unknown vehicle model '" + model + "'; there are " + names + "or a file .toml");
    if (const auto programmed = programmed_model(model)) return {*programmed, {}};
    return parse_model(built_in_model_text(model), model);
  }
  auto file = bus::ConfigFile::load_named(file_or_name);
  return read_model(file);
}

ModelFile parse_model(const std::string& text, const std::string& name_for_errors) {
  auto file = bus::ConfigFile::parse(text, name_for_errors);
  return read_model(file);
}

std::string model_toml(const ModelFile& model) {
  ModelFile written = model;
  return bus::to_toml([&](ConfigVisitor& v) { visit_whole(v, written); }, /*with_comments=*/true);
}

}  // namespace halocline::vehicle_sim
