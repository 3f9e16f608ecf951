// SPDX-License-Identifier: BSD-3-Clause
// Mission plan: a list of behaviours carried out one after another, and their set points.
//
//   kind        action                                                          ends
//   waypoints   passes through points (guidance.h)                              at the last point
//   heading     keeps a heading                                                 after its duration
//   loiter      circles about a point (vector field of guidance.h, mirrored     after its duration
//               for counterclockwise)
//   survey      follows parallel tracks over a rectangle, joined outside of it  at the last point
//   follow      follows a leader (set points from formation.h)                  after its duration
//   wait        is stopped                                                      after its duration
//   seek_link   circles about one of several places (link_seeker.h chooses)     after its duration
//
// Each behaviour has a depth, or a height above the seabed (seabed_ahead.h converts it to a depth). After the
// last one the plan starts again, holds (circles where it ended; a loiter continues), stops, or surfaces.
// Frame: world NED, metres; a depth is z, positive down from the datum. Left out: currents across a heading
// or a circle, obstacles, simultaneous behaviours. Pure functions.
#pragma once

#include <string>
#include <vector>

#include "clients/onboard/autopilot/guidance.h"
#include "core/archive.h"
#include "core/frames.h"

namespace halocline::clients {

enum class BehaviourKind { kWaypoints, kHeading, kLoiter, kSurvey, kFollow, kWait, kSeekLink };
enum class Sense { kClockwise, kCounterclockwise };

// Place of a follower relative to its leader, and its fallback when the leader is lost.
struct Formation {
  std::string leader{};       // name of a vehicle that broadcasts its position
  double along_m = -30;       // ahead of the leader (below 0: astern)
  double across_m = 0;        // to the leader's starboard
  double below_m = 0;         // below the leader
  double fresh_for_s = 25;    // maximum age of a report that is followed, above 0
  double keep_course_s = 30;  // duration for which the last course is then kept
  double safe_depth_m = 10;   // z of the circle after that
  double safe_speed_mps = 1;  // speed on that circle
  double max_speed_mps = 2;   // limit when catching up
};

// Places where a vehicle that seeks a link may go, and the rule by which it chooses.
struct LinkSearch {
  std::string listeners{};  // names of the vehicles that are to hear it, separated by spaces
  // Depths at the centre, z, used when there are no waypoints: the first, the last, and the step, above 0.
  double shallowest_m = 5, deepest_m = 50, step_m = 5;
  double period_s = 60;      // between queries, above 0
  double least_gain = 0.05;  // gain of mean delivery probability that justifies a move, 0 to 1
};

struct Behaviour {
  BehaviourKind kind = BehaviourKind::kWaypoints;
  std::vector<Vec3> waypoints{};                 // points to pass, or candidate places of seek_link
  double duration_s = 0;                         // for heading, loiter, follow, wait, seek_link; 0: unlimited
  double speed_mps = 0;                          // through the water; 0: the mission's speed
  double depth_m = 10;                           // z, for heading, loiter and survey
  double altitude_m = 0;                         // height above the seabed, instead of depth; 0: not used
  double max_depth_m = 1000;                     // limit of z on the way down to an altitude
  double heading_rad = 0;                        // for heading, and for the first track of a survey
  double center_north_m = 0, center_east_m = 0;  // for loiter, survey and seek_link
  double radius_m = 30;  // above 0; for a loiter, a place sought and a follower without its leader
  Sense sense = Sense::kClockwise;
  double length_m = 200,
         width_m = 100;         // box of a survey: along its tracks (above 0) and across them (0 or above)
  double track_spacing_m = 25;  // between the tracks of a survey, above 0
  double turn_m = 30;           // distance outside of the box at which a survey's tracks end, 0 or above
  Formation formation{};
  LinkSearch search{};
};

// Returns the points of a survey. Each track runs from `turn_m` before the box to `turn_m` behind it,
// alternately to and fro; the first runs along the heading at the port side. There are as many tracks as fit,
// centred in the width. z is the depth. Throws InvalidArgument when length or spacing is not above 0, or the
// width below 0.
std::vector<Vec3> survey_points(const Behaviour& survey);

// Behaviours of a plan with their routes, computed once.
struct Plan {
  std::vector<Behaviour> behaviours;  // at least one
  std::vector<Mission> routes;        // one for each behaviour; without waypoints where it has no route
  AtEnd at_end = AtEnd::kHold;
  double hold_radius_m = 30;
};

// Returns the plan. `mission.waypoints` form its only behaviour when `behaviours` is empty. Throws
// InvalidArgument when both are empty.
Plan make_plan(const Mission& mission, std::vector<Behaviour> behaviours);

struct PlanProgress {
  std::size_t index = 0;  // index of the current behaviour
  double since_s = 0;     // simulation time at which it started
  Progress route;
  bool ended = false;  // the last behaviour's duration is over, and the plan does not loop
  Vec3 end_ned_m = Vec3::Zero();

  void archive(Archive& a) { a(index, since_s, route, ended, end_ned_m); }
};

PlanProgress begin(const Vec3& position_ned_m, double time_s);

// Returns the progress past every behaviour that is done at this position and time.
PlanProgress advance(const Plan& plan, PlanProgress progress, const Vec3& position_ned_m, double time_s);

// Returns the set points; for a follower only their speed is meaningful.
SetPoints set_points(const Plan& plan, const PlanProgress& progress, const Vec3& position_ned_m);

}  // namespace halocline::clients
