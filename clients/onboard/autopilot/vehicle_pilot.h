// SPDX-License-Identifier: BSD-3-Clause
// Pilot of one vehicle: from its navigation state to set points, and from these to actuator commands.
//
// The pilot carries out a plan (plan.h), follows a leader by its reports (formation.h), keeps above the
// seabed that its altimeter has measured (seabed_ahead.h), and steers with fins (control_laws.h), with
// thrusters (hover_laws.h) or by buoyancy (glide_laws.h). It is independent of the bus: AutopilotNode
// provides the situations.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "clients/onboard/autopilot/control_laws.h"
#include "clients/onboard/autopilot/formation.h"
#include "clients/onboard/autopilot/glide_laws.h"
#include "clients/onboard/autopilot/guidance.h"
#include "clients/onboard/autopilot/hover_laws.h"
#include "clients/onboard/autopilot/link_seeker.h"
#include "clients/onboard/autopilot/plan.h"
#include "clients/onboard/autopilot/seabed_ahead.h"
#include "core/archive.h"
#include "core/frames.h"

namespace halocline::clients {

// Navigation state at one instant; NED metres, m/s, radians.
struct Situation {
  double time_s = 0;
  Vec3 position_ned_m = Vec3::Zero();
  Vec3 velocity_ned_mps = Vec3::Zero();  // over ground
  EulerAngles attitude;
  double pitch_rate_radps = 0, yaw_rate_radps = 0;
  double water_speed_mps = 0;  // forward speed through the water

  void archive(Archive& a) {
    a(time_s, position_ned_m, velocity_ned_mps, attitude, pitch_rate_radps, yaw_rate_radps, water_speed_mps);
  }
};

// Current activity and its reason. The order is that of the constants in autopilot_status_t.
enum class Activity {
  kWaitingForState,
  kLostState,
  kFollowingLeg,
  kKeepingHeading,
  kLoitering,
  kHolding,   // circles where the plan ended
  kFinished,  // stopped where the plan ended
  kWaitingForLeader,
  kFollowingLeader,
  kLeaderLost,      // keeps its last course
  kCirclingSafely,  // circles without its leader
  kWaiting,
  kSurfacing,    // rises where the plan ended
  kSeekingLink,  // at the place where it is best heard, or on the way there
};

class VehiclePilot {
 public:
  VehiclePilot(Plan plan, SeabedRules seabed_rules);

  void add_altimeter_sample(const AltimeterSample& sample) { seabed_.add(sample); }

  // Adds a report received from the vehicle `leader`.
  void on_leader_report(const std::string& leader, const LeaderReport& report);

  // Returns the set points in this situation. Situations must come in order of time.
  SetPoints steer_for(const Situation& situation);

  ActuatorCommand with_fins(const Gains& gains, const SetPoints& points, const Situation& situation,
                            double dt_s);
  ActuatorCommand by_buoyancy(const GlideGains& glide, const Gains& gains, const SetPoints& points,
                              const Situation& situation, double dt_s);
  // Steers straight to the station of the set points; without one, along their course.
  std::array<double, 4> with_thrusters(const HoverGains& gains, const SetPoints& points,
                                       const Situation& situation, double dt_s);

  // Empty before the first situation.
  const std::optional<PlanProgress>& progress() const { return progress_; }
  // Phase of the current behaviour; empty when it does not follow a leader.
  std::optional<FollowPhase> follow_phase() const;
  const Plan& plan() const { return plan_; }
  // Link seeker of the current behaviour; null when it does not seek a link.
  LinkSeeker* seeker();
  // Activity in the latest situation; kWaitingForState before the first.
  Activity activity() const;
  // Returns the activity in words.
  std::string text() const;
  // Resets to the state of construction.
  void restart();
  void archive(Archive& a);

 private:
  SetPoints planned(const Situation& situation);
  SetPoints circling(const LinkSeeker& seeker, const Vec3& position_ned_m) const;

  Plan plan_;
  SeabedRules seabed_rules_;
  SeabedAhead seabed_;
  std::vector<std::optional<Follower>> followers_;  // one for each behaviour; empty unless it follows
  std::vector<std::optional<LinkSeeker>> seekers_;  // one for each behaviour; empty unless it seeks
  std::optional<PlanProgress> progress_;
  Integrals integrals_;
  HoverIntegrals hover_integrals_;
  GlideState glide_;
};

}  // namespace halocline::clients
