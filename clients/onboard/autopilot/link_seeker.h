// SPDX-License-Identifier: BSD-3-Clause
// Choice of the place where a vehicle is best heard by others.
//
// Rule: the vehicle goes to the place with the greatest mean delivery probability, and among equals to the
// one with the greatest mean SINR, each time that the channel server has been asked. It stays where it is
// when the move would gain less than `least_gain` of mean delivery, so that it does not oscillate between
// places that are alike. When its present place delivers nothing at all, any gain counts. Before the first
// answer the chosen place is the first. Pure functions.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "clients/onboard/autopilot/plan.h"
#include "core/archive.h"
#include "core/frames.h"

namespace halocline::clients {

// Returns the candidate places of a behaviour that seeks a link: its waypoints, or the depths at its
// centre. Throws InvalidArgument when the depths do not ascend by a step above 0.
std::vector<Vec3> places_of(const Behaviour& behaviour);
// Returns the names of the listeners, which `search` separates by spaces.
std::vector<std::string> listeners_of(const LinkSearch& search);

class LinkSeeker {
 public:
  explicit LinkSeeker(const Behaviour& behaviour);

  const std::vector<Vec3>& places() const { return places_; }
  const LinkSearch& search() const { return search_; }
  const Vec3& chosen() const { return places_[chosen_]; }

  // Chooses by the mean delivery probability of each place and the index of the best place. An index or a
  // number of places that does not fit changes nothing.
  void take(const std::vector<double>& mean_delivery, int best);

  void archive(Archive& a) { a(chosen_); }

 private:
  LinkSearch search_;
  std::vector<Vec3> places_;
  std::size_t chosen_ = 0;
};

}  // namespace halocline::clients
