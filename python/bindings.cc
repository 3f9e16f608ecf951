// SPDX-License-Identifier: BSD-3-Clause
// Python module `_halocline`: logs as arrays, arrivals and link budgets. The package python/halocline
// wraps it.
//
// Errors of the caller (InvalidArgument) become ValueError with their text, others RuntimeError. Long
// computations release the interpreter's lock.
#include <array>
#include <cstddef>
#include <optional>
#include <sstream>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "python/log_arrays.h"
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "bus/logs/log_reader.h"
#include "core/check.h"
#include "core/frames.h"
#include "simulation/arrivals/arrival_output.h"
#include "simulation/arrivals/sea_files.h"
#include "simulation/composition.h"
#include "simulation/ensemble/ensemble_output.h"
#include "simulation/ensemble/link_ensemble.h"
#include "simulation/link_output.h"
#include "simulation/link_survey.h"

namespace halocline::clients {
namespace {

namespace py = pybind11;

template <class Number>
py::object array_of(const std::vector<Number>& values, std::size_t begin, std::size_t end,
                    const LogColumn& column) {
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>((end - begin) / column.width)};
  if (column.is_array) shape.push_back(static_cast<py::ssize_t>(column.width));
  return py::array_t<Number>(shape, values.data() + begin);  // copied
}

py::object array_of(const std::vector<std::string>& values, std::size_t begin, std::size_t end,
                    const LogColumn&) {
  py::list texts;
  for (std::size_t i = begin; i < end; ++i) texts.append(values[i]);
  return py::module_::import("numpy").attr("array")(texts, py::arg("dtype") = "U");
}

py::object array_of(const std::vector<LogColumn::Bytes>& values, std::size_t begin, std::size_t end,
                    const LogColumn&) {
  py::object array = py::module_::import("numpy").attr("empty")(end - begin, py::arg("dtype") = "O");
  for (std::size_t i = begin; i < end; ++i)
    array[py::int_(i - begin)] = py::bytes(reinterpret_cast<const char*>(values[i].data()), values[i].size());
  return array;
}

py::object array_of(const LogColumn& column) {
  return std::visit(
      [&](const auto& values) -> py::object {
        if (!column.is_list) return array_of(values, 0, values.size(), column);
        py::object rows =
            py::module_::import("numpy").attr("empty")(column.ends.size(), py::arg("dtype") = "O");
        for (std::size_t row = 0; row < column.ends.size(); ++row)
          rows[py::int_(row)] =
              array_of(values, row == 0 ? 0 : column.ends[row - 1], column.ends[row], column);
        return rows;
      },
      column.values);
}

py::tuple read_log(const std::vector<std::string>& paths, const std::string& channels) {
  LogTables tables;
  std::ostringstream damage;
  {
    const py::gil_scoped_release release;
    LogReader log(paths);
    tables = read_tables(log, channels);
    report_damage(damage, log);
  }
  py::dict families;
  for (const auto& [family, table] : tables.by_family) {
    py::dict columns;
    for (const LogColumn& column : table) columns[py::str(column.name)] = array_of(column);
    families[py::str(family)] = columns;
  }
  if (tables.undecodable > 0) damage << tables.undecodable << " events do not decode\n";
  return py::make_tuple(families, damage.str());
}

// Returns the budget in JSON, the paths in JSON, and notes.
std::tuple<std::string, std::string, std::vector<std::string>> link(
    const std::string& scenario, const std::string& from_text, const std::string& to_text,
    const std::vector<std::string>& overrides, const Vec3& from_velocity, const Vec3& to_velocity,
    std::size_t members) {
  const ScenarioConfig config = load_scenario(scenario, overrides, ScenarioUse::kWater);
  LinkSurveyEnd from = link_end(config, from_text), to = link_end(config, to_text);
  from.velocity_ned_mps = from_velocity;
  to.velocity_ned_mps = to_velocity;
  const LinkSurvey answer = survey_link(config, from, to);
  std::ostringstream paths;
  print_arrivals(paths, {answer.arrivals}, OutputFormat::kJson);
  LinkBands bands;
  if (members > 0) bands = link_bands(config, from, to, members);
  return {with_bands(to_json(from, to, answer), bands), paths.str(), answer.notes};
}

// Sets an option of the sea; names and meanings are those of `halocline arrivals`.
void set(SeaDescription& sea, const std::string& option, const py::handle& value) {
  static const std::vector<
      std::pair<const char*,
                std::variant<std::string SeaDescription::*, double SeaDescription::*, int SeaDescription::*,
                             bool SeaDescription::*, std::optional<double> SeaDescription::*>>>
      kOptions{{"water", &SeaDescription::water},
               {"latitude", &SeaDescription::latitude_deg},
               {"longitude", &SeaDescription::longitude_deg},
               {"sound_speed_mps", &SeaDescription::sound_speed_mps},
               {"bottom", &SeaDescription::bottom},
               {"bottom_depth_m", &SeaDescription::bottom_depth_m},
               {"sediment", &SeaDescription::sediment},
               {"bottom_density_ratio", &SeaDescription::bottom_density_ratio},
               {"bottom_sound_speed_mps", &SeaDescription::bottom_sound_speed_mps},
               {"bottom_attenuation_db", &SeaDescription::bottom_attenuation_db},
               {"surface", &SeaDescription::surface},
               {"wind_mps", &SeaDescription::wind_mps},
               {"absorption", &SeaDescription::absorption},
               {"temperature_degc", &SeaDescription::temperature_degc},
               {"salinity_psu", &SeaDescription::salinity_psu},
               {"ph", &SeaDescription::ph},
               {"frequency_khz", &SeaDescription::frequency_khz},
               {"max_launch_angle_deg", &SeaDescription::max_launch_angle_deg},
               {"steep_direct", &SeaDescription::keep_steep_direct},
               {"crease_angle_deg", &SeaDescription::crease_angle_deg},
               {"max_bounces", &SeaDescription::max_bounces},
               {"min_boundary_factor", &SeaDescription::min_boundary_factor},
               {"min_amplitude_db", &SeaDescription::min_amplitude_db},
               {"diffuse_below_db", &SeaDescription::diffuse_below_db}};
  std::string allowed;
  for (const auto& [name, member] : kOptions) {
    allowed += std::string(allowed.empty() ? "" : ", ") + name;
    if (option != name) continue;
    try {
      std::visit([&](auto m) { sea.*m = value.cast<std::decay_t<decltype(sea.*m)>>(); }, member);
    } catch (const py::cast_error&) {
      throw InvalidArgument(option + " is " + std::string(py::repr(value)) + ", of a wrong type");
    }
    return;
  }
  throw InvalidArgument("'" + option + "' is no option of the sea; allowed are " + allowed);
}

std::string arrivals_json(const acoustics::RayLink& link, const std::string& solver,
                          const py::kwargs& options) {
  SeaDescription description;
  for (const auto& [option, value] : options) set(description, option.cast<std::string>(), value);
  const py::gil_scoped_release release;
  const acoustics::RaySea sea = make_sea(description);
  std::ostringstream paths;
  print_arrivals(paths, {{link, eigenrays(sea, link, solver_of(solver))}}, OutputFormat::kJson);
  return paths.str();
}

}  // namespace

PYBIND11_MODULE(_halocline, m) {
  m.def("read_log", &read_log, py::arg("paths"), py::arg("channels"));
  m.def("names_of", &names_of, py::arg("family"), py::arg("field"));
  m.def(
      "link",
      [](const std::string& scenario, const std::string& from, const std::string& to,
         const std::vector<std::string>& overrides, const std::array<double, 3>& from_velocity,
         const std::array<double, 3>& to_velocity, std::size_t members) {
        return link(scenario, from, to, overrides, Vec3(from_velocity.data()), Vec3(to_velocity.data()),
                    members);
      },
      py::arg("scenario"), py::arg("source"), py::arg("receiver"), py::arg("overrides"),
      py::arg("source_velocity"), py::arg("receiver_velocity"), py::arg("ensemble"),
      py::call_guard<py::gil_scoped_release>());
  m.def(
      "arrivals",
      [](double source_depth_m, double receiver_depth_m, double range_m, const std::string& solver,
         const py::kwargs& sea) {
        return arrivals_json({source_depth_m, receiver_depth_m, range_m}, solver, sea);
      },
      py::arg("source_depth_m"), py::arg("receiver_depth_m"), py::arg("range_m"), py::arg("solver"));
}

}  // namespace halocline::clients
