// SPDX-License-Identifier: BSD-3-Clause
// Warnings about scenarios that run but hardly do what their author intended.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "acoustics/math/frequency_band.h"
#include "acoustics/modem/modem.h"
#include "bus/config/config.h"
#include "bus/config/scenario.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "clients/onboard/autopilot/autopilot_config.h"
#include "clients/onboard/autopilot/plan.h"
#include "core/frames.h"
#include "simulation/composition.h"
#include "simulation/scenario_checks.h"

namespace halocline::clients {
namespace {

using channel_server::VehicleModem;

// Group of vehicles that can exchange packets, directly or through other members of the group.
struct HearingGroup {
  std::vector<const VehicleModem*> modems;  // modems of the group, without duplicates
  std::vector<std::size_t> vehicles;
};

bool receives(const VehicleModem& receiver, const acoustics::Modem& packet) {
  const acoustics::Modem& ears = receiving_modem(receiver, packet);
  return same_family(packet, ears) && band_share(packet.band(), ears.band()) > 0;
}

bool hears(const VehicleModem& receiver, const VehicleModem& sender) {
  const auto rates = sender.rates.all();
  return receives(receiver, sender.modem) || std::any_of(rates.begin(), rates.end(), [&](const auto& rate) {
           return receives(receiver, rate.modem);
         });
}

// Adds a vehicle to the first group that its modem exchanges packets with; further such groups are merged
// into it.
void add(std::vector<HearingGroup>& groups, std::size_t vehicle, const VehicleModem& modem) {
  HearingGroup joined{{&modem}, {vehicle}};
  std::vector<HearingGroup> others;
  for (HearingGroup& group : groups) {
    const bool is_met = std::any_of(group.modems.begin(), group.modems.end(), [&](const VehicleModem* other) {
      return *other == modem || hears(*other, modem) || hears(modem, *other);
    });
    if (!is_met) {
      others.push_back(std::move(group));
      continue;
    }
    const bool is_known = std::any_of(group.modems.begin(), group.modems.end(),
                                      [&](const VehicleModem* other) { return *other == modem; });
    if (is_known) joined.modems.clear();
    joined.modems.insert(joined.modems.begin(), group.modems.begin(), group.modems.end());
    joined.vehicles.insert(joined.vehicles.begin(), group.vehicles.begin(), group.vehicles.end());
  }
  others.push_back(std::move(joined));
  groups = std::move(others);
}

std::string names_of(const ScenarioConfig& config, const HearingGroup& group) {
  constexpr std::size_t kShown = 4;
  std::string names;
  for (std::size_t i = 0; i < std::min(group.vehicles.size(), kShown); ++i)
    names += (i == 0 ? "" : ", ") + config.scenario.vehicles[group.vehicles[i]].name;
  const std::size_t more = group.vehicles.size() - std::min(group.vehicles.size(), kShown);
  return names + (more > 0 ? " and " + std::to_string(more) + " more" : "");
}

// Warns when the vehicles fall into groups that never receive each other.
void check_hearing(const ScenarioConfig& config, bus::ConfigFile& file) {
  constexpr std::size_t kMaxGroups = 16;  // more groups are taken as intended
  std::vector<HearingGroup> groups;
  for (std::size_t i = 0; i < config.scenario.vehicles.size() && groups.size() <= kMaxGroups; ++i) {
    const auto& own = config.channel_server.vehicles.at(i);
    if (own.carries_modem) add(groups, i, own.has_modem ? own.modem : config.channel_server.modem);
  }
  if (groups.size() > kMaxGroups) return;
  std::sort(groups.begin(), groups.end(),
            [](const auto& a, const auto& b) { return a.vehicles.front() < b.vehicles.front(); });
  for (std::size_t g = 1; g < groups.size(); ++g) {
    const std::size_t vehicle = groups[g].vehicles.front();
    file.warn(key_of(vehicle, "modem.family"), groups[g].modems.front()->modem.family,
              names_of(config, groups[g]) + " and " + names_of(config, groups.front()) +
                  " never receive each other: their modems have no family and band in common");
  }
}

// True when a position in metres looks like the origin's latitude and longitude in degrees, in either order.
bool looks_like_degrees(const bus::Scenario& scenario, const Vec3& place_ned_m) {
  constexpr double kNear = 5;  // degrees; no world is as large
  const double north = place_ned_m.x(), east = place_ned_m.y();
  const double latitude = scenario.origin_latitude_deg,
               longitude = std::remainder(scenario.origin_longitude_deg, 360);
  const bool has_origin = latitude != 0 || longitude != 0;
  const auto is_at = [&](double a, double b) {
    return std::abs(a - latitude) < kNear && std::abs(std::remainder(b - longitude, 360)) < kNear;
  };
  const bool is_somewhere = north != 0 && east != 0 && std::abs(north) <= 360 && std::abs(east) <= 360;
  return has_origin && is_somewhere && (is_at(north, east) || is_at(east, north));
}

void check_place(const bus::Scenario& scenario, const std::string& key, const Vec3& place_ned_m,
                 bus::ConfigFile& file) {
  if (looks_like_degrees(scenario, place_ned_m))
    file.warn(key, "", "these are metres north and east of the origin; are degrees meant?");
}

void check_places(const ScenarioConfig& config, bus::ConfigFile& file) {
  for (std::size_t i = 0; i < config.scenario.vehicles.size(); ++i) {
    check_place(config.scenario, key_of(i, "start_ned_m"), config.scenario.vehicles[i].start_ned_m, file);
    const PilotConfig& pilot = config.autopilot.vehicles.at(i);
    const auto check_all = [&](const std::string& key, const std::vector<Vec3>& places) {
      const auto found = std::find_if(places.begin(), places.end(),
                                      [&](const Vec3& p) { return looks_like_degrees(config.scenario, p); });
      if (found != places.end()) check_place(config.scenario, key_of(i, key), *found, file);
    };
    check_all("mission.waypoints", pilot.mission.waypoints);
    for (std::size_t k = 0; k < pilot.behaviours.size(); ++k) {
      const Behaviour& b = pilot.behaviours[k];
      const std::string key = "mission.behaviour." + std::to_string(k);
      check_all(key + ".waypoints", b.waypoints);
      check_all(key + ".center_north_m", {Vec3(b.center_north_m, b.center_east_m, 0)});
    }
  }
}

}  // namespace

void check_intent(const ScenarioConfig& config, bus::ConfigFile& file) {
  check_hearing(config, file);
  check_places(config, file);
}

}  // namespace halocline::clients
