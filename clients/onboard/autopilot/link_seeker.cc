// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/link_seeker.h"

#include <cmath>
#include <sstream>

#include "core/check.h"

namespace halocline::clients {

std::vector<Vec3> places_of(const Behaviour& behaviour) {
  if (!behaviour.waypoints.empty()) return behaviour.waypoints;
  const LinkSearch& search = behaviour.search;
  require(search.step_m > 0 && search.deepest_m >= search.shallowest_m,
          "depths to seek a link at run from the shallowest to the deepest by a step above 0");
  std::vector<Vec3> places;
  const int steps =
      static_cast<int>(std::floor((search.deepest_m - search.shallowest_m) / search.step_m + 1e-9));
  for (int i = 0; i <= steps; ++i)
    places.emplace_back(behaviour.center_north_m, behaviour.center_east_m,
                        search.shallowest_m + i * search.step_m);
  return places;
}

std::vector<std::string> listeners_of(const LinkSearch& search) {
  std::istringstream in(search.listeners);
  std::vector<std::string> names;
  for (std::string name; in >> name;) names.push_back(name);
  return names;
}

LinkSeeker::LinkSeeker(const Behaviour& behaviour)
    : search_(behaviour.search), places_(places_of(behaviour)) {}

void LinkSeeker::take(const std::vector<double>& mean_delivery, int best) {
  if (best < 0 || static_cast<std::size_t>(best) >= places_.size() || mean_delivery.size() != places_.size())
    return;
  const double now = mean_delivery[chosen_], then = mean_delivery[static_cast<std::size_t>(best)];
  if (now <= 0 || then - now >= search_.least_gain) chosen_ = static_cast<std::size_t>(best);
}

}  // namespace halocline::clients
