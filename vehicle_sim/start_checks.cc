// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/start_checks.h"

#include <cmath>
#include <optional>

#include "core/csv_table.h"
#include "core/frames.h"

namespace halocline::vehicle_sim {
namespace {

// Rounded down to centimetres, which suffice for a reader; rounded up a depth would lie below the seabed.
std::string rounded_down(double z_m) { return format_number(std::floor(100 * z_m) / 100); }

// Returns the text that describes the allowed positions; empty when the start lies in the water.
std::string allowed_instead(const Vec3& start_ned_m, double sea_surface_z_m, const Seabed& seabed,
                            const std::string& extent) {
  const std::optional<SeabedPlane> plane = seabed.plane_at(start_ned_m.x(), start_ned_m.y());
  if (!plane) return "the terrain is not known there; allowed is a place on it, " + extent;
  if (start_ned_m.z() >= sea_surface_z_m && start_ned_m.z() <= plane->z_m) return "";
  if (plane->z_m < sea_surface_z_m)
    return "there is land, " + rounded_down(sea_surface_z_m - plane->z_m) +
           " m above the sea; allowed is a place in the water";
  return (start_ned_m.z() > plane->z_m ? "that is below the seabed" : "that is above the sea surface") +
         std::string("; allowed there is a z, positive down, of ") + format_number(sea_surface_z_m) +
         " m (the sea surface) to " + rounded_down(plane->z_m) + " m (the seabed)";
}

}  // namespace

void check_starts(const bus::Scenario& scenario, const Seabed& seabed, const std::string& extent,
                  bus::ConfigFile& file) {
  for (std::size_t i = 0; i < scenario.vehicles.size(); ++i) {
    const bus::VehicleEntry& vehicle = scenario.vehicles[i];
    if (vehicle.model == "external") continue;
    const Vec3& p = vehicle.start_ned_m;
    const std::string allowed = allowed_instead(p, scenario.sea_surface_z_m, seabed, extent);
    if (allowed.empty()) continue;
    file.refuse("vehicle." + std::to_string(i) + ".start_ned_m",
                "[" + format_number(p.x()) + ", " + format_number(p.y()) + ", " + format_number(p.z()) + "]",
                "vehicle " + vehicle.name + ": " + allowed);
  }
}

}  // namespace halocline::vehicle_sim
