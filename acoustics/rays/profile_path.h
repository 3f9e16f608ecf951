// Turns one traced ray over a bottom profile into an arrival, and gives the launch angles that a search begins with.
//
// Equations: acoustics/rays/profile_rays.h.
#pragma once

#include <cstdint>
#include <vector>

#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/arrivals.h"

namespace halocline::acoustics {

// Traces the ray of `theta`, which passes the image `target` of the receiver within a few millimetres of
// unfolded depth, and appends its arrival and its family (acoustics/rays/arrivals.h) unless the options exclude it.
void append_profile_arrival(const ArcTracer& tracer, double theta, double target, std::vector<Arrival>& paths,
                            std::vector<std::uint64_t>& families);

// Launch angles above -steepest and up to `steepest`, rising, rad: close near the horizontal, where rays are
// many and far apart in range; and just on both sides of the angles at which rays graze a knot of the water
// on their first leg.
std::vector<double> fan_angles(const ArcTracer& tracer, double steepest);

// Takes the launch angles out within which rays nowhere go faster than the core's speed, and puts those of its edges in.
// The angle of the edge; 0 where there is no core.
double leave_out_core(const ArcTracer& tracer, std::vector<double>& angles);

}  // namespace halocline::acoustics
