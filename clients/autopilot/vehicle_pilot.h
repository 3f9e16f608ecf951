// SPDX-License-Identifier: BSD-3-Clause
// One vehicle's pilot: from its navigation state to set points, and on to actuator commands.
//
// It carries a plan (plan.h) through, follows a leader by its reports (formation.h), keeps above the
// ground that its altimeter showed it (seabed_ahead.h), and steers with fins (control_laws.h), with
// thrusters (hover_laws.h) or by buoyancy (glide_laws.h). Values in, values out: where a situation comes from
// is the node's.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "clients/autopilot/control_laws.h"
#include "clients/autopilot/formation.h"
#include "clients/autopilot/glide_laws.h"
#include "clients/autopilot/guidance.h"
#include "clients/autopilot/hover_laws.h"
#include "clients/autopilot/link_seeker.h"
#include "clients/autopilot/plan.h"
#include "clients/autopilot/seabed_ahead.h"
#include "core/archive.h"
#include "core/frames.h"

namespace halocline::clients {

// The navigation state at an instant; NED metres, m/s, radians.
struct Situation {
  double time_s = 0;
  Vec3 position_ned_m = Vec3::Zero();
  Vec3 velocity_ned_mps = Vec3::Zero();  // over ground
  EulerAngles attitude;
  double pitch_rate_radps = 0, yaw_rate_radps = 0;
  double water_speed_mps = 0;  // forward through the water

  void archive(Archive& a) {
    a(time_s, position_ned_m, velocity_ned_mps, attitude, pitch_rate_radps, yaw_rate_radps, water_speed_mps);
  }
};

// What it does, and why: autopilot_status_t, in its order.
enum class Activity {
  kWaitingForState,
  kLostState,
  kFollowingLeg,
  kKeepingHeading,
  kLoitering,
  kHolding,   // where the plan ended
  kFinished,  // stopped where the plan ended
  kWaitingForLeader,
  kFollowingLeader,
  kLeaderLost,      // keeps its course
  kCirclingSafely,  // without its leader
  kWaiting,
  kSurfacing,    // where the plan ended
  kSeekingLink,  // at the place where it is best heard, or on the way there
};

class VehiclePilot {
 public:
  VehiclePilot(Plan plan, SeabedRules seabed_rules);

  void look_at_ground(const AltimeterLook& look) { seabed_.add(look); }

  // A report received from the vehicle `leader`.
  void on_leader_report(const std::string& leader, const LeaderReport& report);

  // What to steer for in this situation. Situations come in order of time.
  SetPoints steer_for(const Situation& situation);

  ActuatorCommand with_fins(const Gains& gains, const SetPoints& points, const Situation& situation,
                            double dt_s);
  ActuatorCommand by_buoyancy(const GlideGains& glide, const Gains& gains, const SetPoints& points,
                              const Situation& situation, double dt_s);
  // Straight to the point steered for where there is one, else along the course.
  std::array<double, 4> with_thrusters(const HoverGains& gains, const SetPoints& points,
                                       const Situation& situation, double dt_s);

  // Empty before the first situation.
  const std::optional<PlanProgress>& progress() const { return progress_; }
  // Of the behaviour at hand; empty when it does not follow.
  std::optional<FollowPhase> follow_phase() const;
  const Plan& plan() const { return plan_; }
  // Of the behaviour at hand; null when it does not seek a link.
  LinkSeeker* seeker();
  // Of the latest situation; kWaitingForState before the first.
  Activity activity() const;
  // What it does, in words.
  std::string text() const;
  // As if nothing had happened yet.
  void restart();
  void archive(Archive& a);

 private:
  SetPoints planned(const Situation& situation);
  SetPoints circling(const LinkSeeker& seeker, const Vec3& position_ned_m) const;

  Plan plan_;
  SeabedRules seabed_rules_;
  SeabedAhead seabed_;
  std::vector<std::optional<Follower>> followers_;  // of each behaviour that follows
  std::vector<std::optional<LinkSeeker>> seekers_;  // of each that seeks a link
  std::optional<PlanProgress> progress_;
  Integrals integrals_;
  HoverIntegrals hover_integrals_;
  GlideState glide_;
};

}  // namespace halocline::clients
