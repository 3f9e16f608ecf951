// SPDX-License-Identifier: BSD-3-Clause
// Which of several places a vehicle goes to so that others hear it best.
//
// Rule. It goes to the place of the greatest mean delivery, of equals that of the greatest ratio, whenever it
// is asked for, but stays where that gains less than `least_gain` of mean delivery: so it does not run to and
// fro between places alike. Where the present place delivers nothing at all, any gain counts. Before the
// first answer it is the first place. Pure.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "clients/autopilot/plan.h"
#include "core/archive.h"
#include "core/frames.h"

namespace halocline::clients {

// The places of a behaviour that seeks a link: its waypoints, or the depths above its centre.
std::vector<Vec3> places_of(const Behaviour& behaviour);
// The names in a text with spaces between.
std::vector<std::string> listeners_of(const LinkSearch& search);

class LinkSeeker {
 public:
  explicit LinkSeeker(const Behaviour& behaviour);

  const std::vector<Vec3>& places() const { return places_; }
  const LinkSearch& search() const { return search_; }
  const Vec3& chosen() const { return places_[chosen_]; }

  // How well each place is heard, and which is the best; one that is out of range changes nothing.
  void take(const std::vector<double>& mean_delivery, int best);

  void archive(Archive& a) { a(chosen_); }

 private:
  LinkSearch search_;
  std::vector<Vec3> places_;
  std::size_t chosen_ = 0;
};

}  // namespace halocline::clients
