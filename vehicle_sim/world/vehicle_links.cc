// The part of VehicleWorld that lets vehicles meet and pull each other.
#include <algorithm>

#include "core/check.h"
#include "vehicle_sim/world/ode_bodies.h"

namespace halocline::vehicle_sim {
namespace {

constexpr double kMinDistance = 1e-6;  // m: a rope whose ends meet has no direction

// Velocity of the body's point, world frame; `cg` where the point is.
Vec3 velocity_at(const Motion& cg, const Vec3& point) {
  return cg.velocity + cg.angular_velocity.cross(point - cg.position);
}

// Where the free velocity leads.
VehicleState reached_freely(const Model& model, const VehicleState& now, const VehicleState& free,
                            double step_s) {
  Motion motion = motion_of_cg(model, free);
  motion.position = motion_of_cg(model, now).position;
  return moved(model, now, motion, step_s);
}

// A hull on its way through a step.
struct HullPath {
  HullShape hull;
  Vec3 from, to;
  Quaternion orientation_from, orientation_to;

  HullPose at(double time) const {  // 0 to 1
    return {hull, from + time * (to - from), orientation_from.slerp(time, orientation_to) * Vec3::UnitX()};
  }
};

HullPath path_of(const HullShape& hull, const VehicleState& from, const VehicleState& to) {
  return {hull, from.position_ned_m, to.position_ned_m, from.orientation, to.orientation};
}

bool overlap(const std::vector<VehicleContact>& contacts) {
  constexpr double kTouching = 1e-3;  // m
  return std::any_of(contacts.begin(), contacts.end(),
                     [](const VehicleContact& c) { return c.gap_m < -kTouching; });
}

// Contacts at the end of the step or, when the hulls would lie in each other then, at the last instant before: beyond
// it pointed ends have passed each other, and the way apart leads on. Returns the instant, 0 to 1.
double find_first_touch(const HullPath& first, const HullPath& second,
                        std::vector<VehicleContact>& contacts) {
  constexpr int kHalvings = 7;
  const auto look_at = [&](double time) {
    find_vehicle_contacts(first.at(time), second.at(time), kContactMargin, contacts);
    return overlap(contacts);
  };
  if (!look_at(1)) return 1;
  double free_at = 0, overlaps_at = 1;
  for (int i = 0; i < kHalvings; ++i) {
    const double time = (free_at + overlaps_at) / 2;
    (look_at(time) ? overlaps_at : free_at) = time;
  }
  look_at(free_at);
  return free_at;
}

}  // namespace

std::size_t VehicleWorld::add(const Tether& tether) {
  require(tether.vehicle < vehicles_.size(), "a tether needs a vehicle");
  require(!tether.to_vehicle || *tether.to_vehicle < vehicles_.size(),
          "a tether needs a vehicle at its other end");
  require(tether.to_vehicle != tether.vehicle, "a tether must not lead from a vehicle to itself");
  require_in_range(tether.length_m, 1e-3, 1e6, "tether length", "m");
  require(tether.attached_at_m.allFinite() && tether.to_attached_at_m.allFinite(),
          "a tether's end is not finite");
  tethers_.push_back({tether});
  return tethers_.size() - 1;
}

double VehicleWorld::tether_distance_m(std::size_t index) const {
  const Tether& t = tethers_[index].tether;
  return (end_of(t.vehicle, t.attached_at_m, false) - end_of(t.to_vehicle, t.to_attached_at_m, false)).norm();
}

// An end of a tether, where its vehicle is or where its free velocity leads.
Vec3 VehicleWorld::end_of(const std::optional<std::size_t>& vehicle, const Vec3& attached_at_m,
                          bool when_reached) const {
  if (!vehicle) return attached_at_m;
  const Vehicle& v = vehicles_[*vehicle];
  const VehicleState& state = when_reached ? v.reached : v.state;
  return state.position_ned_m + state.orientation * attached_at_m;
}

// Pairs in ascending order, then tethers: the order of ODE's joints, and with it the result, is that of the indices.
void VehicleWorld::find_links(double step_s) {
  if (vehicles_.size() > 1) find_meetings(step_s);
  find_taut_tethers(step_s);
  for (Link& link : links_) {
    take_scale_of(vehicles_[link.vehicle], link);
    if (link.other) take_scale_of(vehicles_[*link.other], link);
  }
  for (Vehicle& v : vehicles_) {
    if (!v.linked) continue;
    scale_mass(v.body, v.model->parameters(), v.mass_scale);
    VehicleState there = v.state;
    there.orientation = v.reached.orientation;
    there.velocity_body = v.state.velocity_body;
    set_motion_of_cg(there, *v.model, motion_of_cg(*v.model, v.state));
    const Vec3 cg = motion_of_cg(*v.model, v.reached).position;
    write_body(v.body, *v.model, there);
    dBodySetPosition(v.body, cg.x(), cg.y(), cg.z());
  }
}

void VehicleWorld::find_meetings(double step_s) {
  positions_.clear();
  for (const Vehicle& v : vehicles_)
    positions_.push_back(v.lost ? v.state.position_ned_m : v.next.position_ned_m);
  // next and reached differ by less than the margin: half an acceleration times the step squared.
  for (const auto& [i, k] : neighbours_.within(longest_hull_m_ + 4 * kContactMargin, positions_)) {
    Vehicle &a = vehicles_[i], &b = vehicles_[k];
    if (a.lost || b.lost) continue;
    a.reached = reached_freely(*a.model, a.state, a.next, step_s);
    b.reached = reached_freely(*b.model, b.state, b.next, step_s);
    const double time = find_first_touch(path_of(a.model->parameters().hull, a.state, a.reached),
                                         path_of(b.model->parameters().hull, b.state, b.reached), meeting_);
    for (const VehicleContact& c : meeting_)
      links_.push_back({i, k, c.point_ned_m, c.normal_ned, c.gap_m, (1 - time) * step_s, {}});
  }
}

void VehicleWorld::find_taut_tethers(double step_s) {
  for (std::size_t i = 0; i < tethers_.size(); ++i) {
    tethers_[i].pull_n = 0;
    const Tether& t = tethers_[i].tether;
    bool is_whole = true;
    for (const auto& end : {std::optional(t.vehicle), t.to_vehicle}) {
      if (!end) continue;
      Vehicle& v = vehicles_[*end];
      is_whole = is_whole && !v.lost;
      if (!v.lost) v.reached = reached_freely(*v.model, v.state, v.next, step_s);
    }
    if (!is_whole) continue;
    const Vec3 from = end_of(t.vehicle, t.attached_at_m, true),
               to = end_of(t.to_vehicle, t.to_attached_at_m, true);
    const double distance = (to - from).norm(), slack = t.length_m - distance;
    if (slack > kContactMargin || distance < kMinDistance) continue;
    links_.push_back({t.vehicle, t.to_vehicle, from, (to - from) / distance, slack, 0, i});
  }
}

// Lets ODE's body give way at its closest link as the vehicle does, with its added mass.
void VehicleWorld::take_scale_of(Vehicle& v, const Link& link) {
  if (v.linked && v.closest_link_m <= link.gap_m) return;
  v.linked = true;
  v.closest_link_m = link.gap_m;
  const Quaternion to_body = v.reached.orientation.conjugate();
  const Vec3 arm = to_body * (link.point - motion_of_cg(*v.model, v.reached).position);
  const Vec3 direction = to_body * link.normal;
  v.mass_scale = ode_inverse_mass_at(v.model->parameters(), arm, direction) /
                 inverse_mass_at(*v.model, v.reached, link.point, link.normal);
}

void VehicleWorld::attach_link(Link& link, double step_s) {
  const auto free_velocity = [&](std::size_t index) {
    const Vehicle& v = vehicles_[index];
    Motion cg = motion_of_cg(*v.model, v.next);
    cg.position = motion_of_cg(*v.model, v.reached).position;
    return velocity_at(cg, link.point);
  };
  double free_speed = link.normal.dot(free_velocity(link.vehicle));
  if (link.other) free_speed -= link.normal.dot(free_velocity(*link.other));
  const double gap = link.gap_m + link.time_left_s * free_speed;  // at the end of the step
  const double min_speed = std::min(free_speed - gap / step_s, kFastestPushOut);
  const dContact contact = ode_contact(link.normal, link.point, -min_speed, 0);
  link.joint = dJointCreateContact(ode_->world(), ode_->contacts(), &contact);
  dJointAttach(link.joint, vehicles_[link.vehicle].body, link.other ? vehicles_[*link.other].body : nullptr);
  dJointSetFeedback(link.joint, &link.feedback);
}

void VehicleWorld::note_what_links_did() {
  for (Vehicle& v : vehicles_) {
    v.link_force.setZero();
    v.touches_vehicle = false;
  }
  for (const Link& link : links_) {
    const double force = std::max(0.0, link.normal.dot(vector_from(link.feedback.f1)));
    vehicles_[link.vehicle].link_force += force * link.normal;
    if (link.other) vehicles_[*link.other].link_force -= force * link.normal;
    if (link.tether) {
      tethers_[*link.tether].pull_n = force;
    } else if (force > 0) {
      vehicles_[link.vehicle].touches_vehicle = vehicles_[*link.other].touches_vehicle = true;
    }
  }
}

void VehicleWorld::take_struck(std::size_t index, double step_s) {
  Impulse total;
  for (const Link& link : links_) {
    if (link.vehicle != index && link.other != index) continue;
    const double force = std::max(0.0, link.normal.dot(vector_from(link.feedback.f1)));
    const Impulse one =
        impulse_of((link.vehicle == index ? force : -force) * link.normal, link.point, step_s);
    total.linear += one.linear;
    total.moment += one.moment;
  }
  Vehicle& v = vehicles_[index];
  v.next = struck(*v.model, v.state, v.next, total, v.water.current_ned_mps, step_s);
}

}  // namespace halocline::vehicle_sim
