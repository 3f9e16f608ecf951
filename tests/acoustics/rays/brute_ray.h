// SPDX-License-Identifier: BSD-3-Clause
// One ray through layered water over a polyline bottom, followed the plain way: an independent reference for
// tests.
//
// Written from the geometry alone and sharing no formula with the solvers: an arc leaves and meets a chord at
// equal angles, so dr = dz (cos1 + cos2) / (sin1 + sin2); time along it is 2 asinh(|g| chord / (2 sqrt(c1
// c2))) / |g|; its first meeting with a facet is bracketed by the place where arc and facet are parallel and
// then bisected. The ray tube (q, p) is Cerveny's dynamic ray tracing. On a `curved` bottom rays meet the
// straight facets but are reflected as by normals that go evenly from point to point, at a point the mean of
// both facets' directions, at the first and the last point that of the facet itself.
#pragma once

#include <cstdint>
#include <vector>

#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/sound_speed_profile.h"

namespace halocline::acoustics {

struct BruteSea {
  std::vector<SpeedRow> knots;        // from 0 to below the deepest bottom
  std::vector<ProfiledDepth> bottom;  // one point: flat
  bool curved = false;                // points sample a smooth curve
  FluidBottom sediment;
  double min_factor = 0.005;
};

struct BruteRay {
  double theta = 0;
  bool arrived = false;  // at the receiver's range, with bounces that leave min_factor of the pressure
  double z = 0, sine = 0, cosine = 1, time_s = 0, speed = 0;
  double slope = 0;  // dz / dtheta, by the tube
  double q = 0;
  double factor = 1, bottom_phase_rad = 0;
  int surface = 0, bottom = 0, caustics = 0;
  std::uint64_t bounces = 0;  // which boundary, and on a bottom that is not curved which facet, in order
  std::uint64_t turns = 0;    // in which layers the water turned it back, in order
};

class BruteTracer {
 public:
  BruteTracer(const BruteSea& sea, double source_m, double range_m);
  BruteRay trace(double theta) const;
  double source_speed() const { return source_speed_; }
  // Launch angles (> 0) whose rays graze a knot before they meet a bottom that slopes.
  std::vector<double> grazing_angles() const;

 private:
  struct Facet {
    double r0, r1, z0, slope, angle, angle0, angle1;  // directions: its own, and as reflected at both ends
  };
  struct State;
  bool first_meeting(const State& s, double reach, double& x, std::size_t& facet) const;
  static double depth_after(const State& s, double x, double* sine);
  void advance(State& s, BruteRay& ray, double dx, double z, double sine) const;
  void cross(State& s, bool down) const;
  static void meet_surface(State& s, BruteRay& ray);
  bool meet_bottom(State& s, BruteRay& ray, std::size_t facet) const;

  BruteSea sea_;
  std::vector<Facet> facets_;
  double source_, range_, source_speed_, shallowest_ = 1e9;
};

}  // namespace halocline::acoustics
