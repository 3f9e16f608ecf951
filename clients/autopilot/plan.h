// SPDX-License-Identifier: BSD-3-Clause
// From a list of behaviours to set points: what a pilot does, one thing after another.
//
// Behaviours: waypoints (guidance.h); a heading kept; a loiter, a circle of given radius and sense about a
// point (the vector field of guidance.h, mirrored for counterclockwise); a survey, parallel tracks over a
// rectangle joined outside of it; following a leader (formation.h gives its set points); waiting, stopped;
// seeking a link, a circle about one of several places (link_seeker.h chooses). Waypoints and
// surveys end at their last point, the others after their duration. Each at a depth, or at a height above
// the ground (seabed_ahead.h turns it into a depth). After the last one: again from the first, hold
// (circle where it ended; a loiter goes on), stop, or come to the surface. Frame: world NED, metres; z of a
// depth is down from the datum. Left out: current across a heading or a circle, obstacles, behaviours at
// once. Pure functions.
#pragma once

#include <string>
#include <vector>

#include "clients/autopilot/guidance.h"
#include "core/archive.h"
#include "core/frames.h"

namespace halocline::clients {

enum class BehaviourKind { kWaypoints, kHeading, kLoiter, kSurvey, kFollow, kWait, kSeekLink };
enum class Sense { kClockwise, kCounterclockwise };

// Where a follower keeps from its leader, and what it does without it.
struct Formation {
  std::string leader{};       // name of a vehicle that broadcasts its place
  double along_m = -30;       // ahead of the leader (below 0: astern)
  double across_m = 0;        // to its starboard
  double below_m = 0;         // below it
  double fresh_for_s = 25;    // age up to which a report is followed, above 0
  double keep_course_s = 30;  // how long the last course is kept after that
  double safe_depth_m = 10;   // z it then circles at
  double safe_speed_mps = 1;  // and how fast
  double max_speed_mps = 2;   // to catch up with
};

// Where a vehicle that seeks a link may go, and how it chooses.
struct LinkSearch {
  std::string listeners{};  // names, with spaces between: who is to hear it
  // Depths above the centre, z, where no places are given: the first, the last, the step above 0.
  double shallowest_m = 5, deepest_m = 50, step_m = 5;
  double period_s = 60;      // between questions, above 0
  double least_gain = 0.05;  // of mean delivery, for which it moves, 0..1
};

struct Behaviour {
  BehaviourKind kind = BehaviourKind::kWaypoints;
  std::vector<Vec3> waypoints{};                 // of seeking a link: the places; none: depths
  double duration_s = 0;                         // of heading, loiter, follow, wait, seek_link; 0: for ever
  double speed_mps = 0;                          // through the water; 0: the mission's
  double depth_m = 10;                           // z, of heading, loiter and survey
  double altitude_m = 0;                         // above the ground, instead of depth; 0: not used
  double max_depth_m = 1000;                     // z never passed on the way down to an altitude
  double heading_rad = 0;                        // of heading; of a survey's first track
  double center_north_m = 0, center_east_m = 0;  // of loiter, survey and seek_link
  double radius_m = 30;  // of a loiter, a place sought and a lost follower's circle; above 0
  Sense sense = Sense::kClockwise;
  double length_m = 200,
         width_m = 100;         // of a survey's box, along and across its tracks; above 0, 0 or above
  double track_spacing_m = 25;  // of a survey, above 0
  double turn_m = 30;           // how far outside of the box its tracks end, 0 or above
  Formation formation{};
  LinkSearch search{};
};

// The points of a survey: each track from `turn_m` before the box to `turn_m` behind it, to and fro, the
// first along the heading at the port side. The tracks are as many as fit, their rest is left evenly at both
// sides. z is the depth.
std::vector<Vec3> survey_points(const Behaviour& survey);

// Behaviours with what is computed of them once.
struct Plan {
  std::vector<Behaviour> behaviours;  // at least one
  std::vector<Mission> routes;        // of each; without waypoints where it has none
  AtEnd at_end = AtEnd::kHold;
  double hold_radius_m = 30;
};

// `mission.waypoints` are one behaviour when there is no other. Throws InvalidArgument when there is neither.
Plan make_plan(const Mission& mission, std::vector<Behaviour> behaviours);

struct PlanProgress {
  std::size_t index = 0;  // of the behaviour
  double since_s = 0;     // simulation time of its start
  Progress route;
  bool ended = false;  // the last one's duration is over, and the plan does not loop
  Vec3 end_ned_m = Vec3::Zero();

  void archive(Archive& a) { a(index, since_s, route, ended, end_ned_m); }
};

PlanProgress begin(const Vec3& position_ned_m, double time_s);

// Moves on past every behaviour that is done at this place and time.
PlanProgress advance(const Plan& plan, PlanProgress progress, const Vec3& position_ned_m, double time_s);

// The set points; of a leader's follower only the speed.
SetPoints set_points(const Plan& plan, const PlanProgress& progress, const Vec3& position_ned_m);

}  // namespace halocline::clients
