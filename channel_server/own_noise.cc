// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/own_noise.h"

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <string>

#include "bus/config/carried_files.h"
#include "bus/config/config.h"

namespace halocline::channel_server {
namespace {

constexpr double kTipSpeedMps = 11;

// Diameter of the largest propeller of a model, m; 0 without one.
double largest_propeller_m(std::string_view name);

// Reads the keys of a model file that describe propellers (vehicle_sim/model_config.h has all of them).
double largest_propeller_m(bus::ConfigFile& file) {
  double largest_m = 0;
  file.read([&](bus::ConfigVisitor& v) {
    std::string base;
    v.text("based_on", base, {}, "");
    double propeller_m = largest_propeller_m(base);
    std::vector<double> thrusters_m;
    const auto diameter = [](double& value_m) {
      return [&value_m](bus::ConfigVisitor& s) { s.number("diameter_m", value_m, {0, 1000, "m", ""}); };
    };
    v.section("propeller", "", diameter(propeller_m));
    v.list(
        "thruster", "", 0, [&](std::size_t n) { thrusters_m.resize(n); },
        [&](bus::ConfigVisitor& s, std::size_t i) { diameter(thrusters_m[i])(s); });
    largest_m = propeller_m;
    for (const double thruster_m : thrusters_m) largest_m = std::max(largest_m, thruster_m);
  });
  return largest_m;
}

double largest_propeller_m(std::string_view name) {
  for (const auto& [known, text] : vehicle_model_texts()) {
    if (name != known) continue;
    auto file = bus::ConfigFile::parse(std::string(text), std::string(name));
    return largest_propeller_m(file);
  }
  return 0;
}

}  // namespace

std::optional<NoiseSource> propeller_noise(const FilePath& model) {
  double largest_m = 0;
  if (bus::names_a_file(model.place(), bus::FileNames::kShipped)) {
    auto file = bus::ConfigFile::load_named(model);
    largest_m = largest_propeller_m(file);
  } else {
    largest_m = largest_propeller_m(model.place());
  }
  if (!(largest_m > 0)) return std::nullopt;
  NoiseSource noise;
  noise.reference = kTipSpeedMps / (std::numbers::pi * largest_m);
  noise.is_heard_by_others = false;
  return noise;
}

}  // namespace halocline::channel_server
