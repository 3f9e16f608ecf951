// SPDX-License-Identifier: BSD-3-Clause
#include "ocean/cf_grid.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace halocline::ocean {
namespace {

constexpr std::array kKinds{AxisKind::kTime, AxisKind::kDepth, AxisKind::kLatitude, AxisKind::kLongitude};
constexpr std::array<std::string_view, 5> kKindNames{"time", "depth", "latitude", "longitude", "unknown"};

std::size_t index_of(AxisKind kind) { return static_cast<std::size_t>(kind); }

// Returns the first index of an axis along its dimension, and the number of indices up to its last.
std::pair<std::size_t, std::size_t> span_of(const CfAxis& axis) {
  const auto [least, greatest] = std::minmax_element(axis.places.begin(), axis.places.end());
  return {*least, *greatest - *least + 1};
}

}  // namespace

CfGrid::CfGrid(const NetcdfFile& file, const std::string& variable, double latitude_deg, double longitude_deg)
    : file_(file) {
  for (const std::string& dimension : file.dimensions_of(variable)) {
    const std::string name = coordinate_of(file, variable, dimension);
    const AxisKind kind = name.empty() ? AxisKind::kOther : kind_of(file, name);
    if (kind != AxisKind::kOther) {
      add(kind, read_axis(file, name, kind, latitude_deg));
    } else if (file.length_of(dimension) != 1) {
      refuse_axis(variable, dimension, name);
    }
  }
  add_scalars(variable, latitude_deg);
  require_complete(variable);
  if (at(AxisKind::kTime).values.empty()) axis(AxisKind::kTime) = {.values = {0}, .places = {0}};
  move_seam(axis(AxisKind::kLongitude), longitude_deg);
}

// Adds an axis. A second axis of one kind is accepted if one of the two has a single value, such as the start
// time of a forecast: it does not locate the values and is dropped.
void CfGrid::add(AxisKind kind, CfAxis found) {
  CfAxis& known = axis(kind);
  if (!known.name.empty() && known.values.size() > 1 && found.values.size() > 1)
    file_.refuse(found.name, "is a second axis of " + std::string(kKindNames[index_of(kind)]) + " beside " +
                                 known.name + "; allowed is one");
  if (known.values.size() <= 1) known = std::move(found);
}

void CfGrid::add_scalars(const std::string& variable, double latitude_deg) {
  for (const std::string& name : auxiliary_coordinates(file_, variable)) {
    if (!file_.dimensions_of(name).empty()) continue;
    const AxisKind kind = kind_of(file_, name);
    if (kind != AxisKind::kOther && at(kind).name.empty())
      add(kind, read_axis(file_, name, kind, latitude_deg));
  }
}

void CfGrid::refuse_axis(const std::string& variable, const std::string& dimension,
                         const std::string& name) const {
  const std::string places = curvilinear_places(file_, variable);
  const std::string what = name.empty() ? "has no coordinate variable of one dimension"
                                        : "is no axis of time, depth, latitude or longitude (units \"" +
                                              file_.text(name, "units") + "\")";
  file_.refuse(variable, "its dimension " + dimension + " " + what + (places.empty() ? "" : "; " + places) +
                             "; allowed are axes of latitude and longitude: regrid it first (cdo remapbil)");
}

void CfGrid::require_complete(const std::string& variable) const {
  std::string found, missing;
  for (const AxisKind kind : kKinds) {
    const std::string name(kKindNames[index_of(kind)]);
    if (!at(kind).name.empty()) found += (found.empty() ? "" : ", ") + name;
    if (at(kind).name.empty() && kind != AxisKind::kTime) missing += (missing.empty() ? "" : ", ") + name;
  }
  if (!missing.empty())
    file_.refuse(variable, "its axes are " + (found.empty() ? "none" : found) +
                               "; allowed are time (or none), depth, latitude and longitude, in any order: " +
                               "there is no axis of " + missing);
}

double CfGrid::points() const {
  double product = 1;
  for (const AxisKind kind : kKinds) product *= static_cast<double>(at(kind).values.size());
  return product;
}

void CfGrid::keep(AxisKind kind, std::size_t first, std::size_t count) {
  const auto cut = [&](auto& of) {
    of.erase(of.begin() + static_cast<std::ptrdiff_t>(first + count), of.end());
    of.erase(of.begin(), of.begin() + static_cast<std::ptrdiff_t>(first));
  };
  cut(axis(kind).values);
  cut(axis(kind).places);
}

bool CfGrid::is_as(const CfGrid& other) const {
  return std::all_of(kKinds.begin(), kKinds.end(),
                     [&](AxisKind kind) { return at(kind).values == other.at(kind).values; });
}

// Returns the kind of each dimension of a variable, in its order; kOther: a dimension without a kind, of
// length 1.
std::vector<AxisKind> CfGrid::kinds_in(const std::string& variable) const {
  std::vector<AxisKind> kinds;
  for (const std::string& dimension : file_.dimensions_of(variable)) {
    const auto* found = std::find_if(axes_.begin(), axes_.end(),
                                     [&](const CfAxis& axis) { return axis.dimension == dimension; });
    if (found == axes_.end() && file_.length_of(dimension) != 1) refuse_other_grid(variable);
    kinds.push_back(static_cast<AxisKind>(found - axes_.begin()));
  }
  for (const AxisKind kind : kKinds) {
    if (!at(kind).dimension.empty() && std::count(kinds.begin(), kinds.end(), kind) != 1)
      refuse_other_grid(variable);
  }
  return kinds;
}

void CfGrid::refuse_other_grid(const std::string& variable) const {
  file_.refuse(variable, "is on other dimensions than the variables before it; allowed is one grid");
}

// Returns the box of a variable that is read at once: one instant, and the kept range of every other axis.
CfGrid::Box CfGrid::box_of(const std::string& variable) const {
  Box box;
  const std::vector<AxisKind> kinds = kinds_in(variable);
  for (const AxisKind kind : kinds) {
    const bool is_single = kind == AxisKind::kOther || kind == AxisKind::kTime;
    if (kind == AxisKind::kTime) box.time = box.from.size();
    const auto [first, count] = is_single ? std::pair<std::size_t, std::size_t>{0, 1} : span_of(at(kind));
    box.from.push_back(first);
    box.counts.push_back(count);
  }
  std::size_t step = 1;
  for (std::size_t d = kinds.size(); d-- > 0; step *= box.counts[d]) {
    box.steps[index_of(kinds[d])] = step;
    box.first[index_of(kinds[d])] = box.from[d];
  }
  return box;
}

std::vector<float> CfGrid::read(const std::string& variable, const UnitFactor& unit) const {
  Box box = box_of(variable);
  const auto offset = [&](AxisKind kind, std::size_t place) {
    return box.steps[index_of(kind)] * (place - box.first[index_of(kind)]);
  };
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(points()));
  for (const std::size_t time : at(AxisKind::kTime).places) {
    if (box.time) box.from[*box.time] = time;
    const std::vector<double> read = file_.values(variable, box.from, box.counts);
    for (const std::size_t depth : at(AxisKind::kDepth).places) {
      for (const std::size_t row : at(AxisKind::kLatitude).places) {
        const std::size_t start = offset(AxisKind::kDepth, depth) + offset(AxisKind::kLatitude, row);
        for (const std::size_t column : at(AxisKind::kLongitude).places)
          values.push_back(static_cast<float>(unit(read[start + offset(AxisKind::kLongitude, column)])));
      }
    }
  }
  return values;
}

}  // namespace halocline::ocean
