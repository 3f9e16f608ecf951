// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/world/vehicle_world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"
#include "vehicle_sim/dynamics/body_motion.h"
#include "vehicle_sim/dynamics/equations_of_motion.h"
#include "vehicle_sim/dynamics/vehicle_model.h"
#include "vehicle_sim/world/ode_bodies.h"
#include "vehicle_sim/world/ode_handles.h"

namespace halocline::vehicle_sim {
namespace {

constexpr double kUnitTolerance = 1e-6;  // tolerance of a quaternion's length
constexpr double kMinForce = 1e-9;       // N: a smaller force is no contact
constexpr double kMinDistance = 1e-6;    // m: a tether whose ends coincide has no direction

}  // namespace

struct VehicleWorld::Contact {
  std::size_t vehicle;
  dJointID joint;
  dJointFeedback feedback = {};
};

// Link: a push along a line between two vehicles, or a vehicle and a fixed point, which keeps a gap open.
struct VehicleWorld::Link {
  std::size_t vehicle;               // pushed along `normal`
  std::optional<std::size_t> other;  // pushed against `normal`
  Vec3 point, normal;                // at the poses to which the free velocities lead
  double gap_m;
  double time_left_s;  // from the instant of `gap_m` to the end of the step
  std::optional<std::size_t> tether;
  dJointID joint = nullptr;
  dJointFeedback feedback = {};
};

VehicleWorld::VehicleWorld(std::shared_ptr<const Seabed> seabed, double friction, ForEach for_each)
    : seabed_(std::move(seabed)),
      friction_(friction),
      for_each_(std::move(for_each)),
      ode_(std::make_unique<OdeWorld>()) {
  require_in_range(friction, 0, 100, "seabed friction");
}

VehicleWorld::~VehicleWorld() = default;

std::size_t VehicleWorld::add(std::shared_ptr<const Model> model, const VehicleState& initial) {
  require(model != nullptr, "a vehicle needs a model");
  require(is_finite(initial), "the initial state is not finite");
  require_in_range(initial.orientation.norm(), 1 - kUnitTolerance, 1 + kUnitTolerance, "quaternion norm");
  Vehicle vehicle{.model = std::move(model), .state = initial};
  vehicle.state.orientation.normalize();
  vehicle.body = make_body(ode_->world(), *vehicle.model, vehicle.state);
  dBodyDisable(vehicle.body);
  longest_hull_m_ = std::max(longest_hull_m_, vehicle.model->parameters().hull.length_m);
  vehicles_.push_back(std::move(vehicle));
  return vehicles_.size() - 1;
}

void VehicleWorld::archive(Archive& a) {
  for (Vehicle& v : vehicles_)
    a(v.state, v.diverged, v.seabed_force, v.link_force, v.touches, v.touches_vehicle);
  for (TiedTether& tether : tethers_) a(tether.pull_n);
}

void VehicleWorld::set_command(std::size_t index, const ActuatorValues& command) {
  require(is_finite(command), "a command is not finite");
  vehicles_.at(index).command = command;
}

void VehicleWorld::set_water(std::size_t index, const Water& water) {
  require(water.current_ned_mps.allFinite() && water.current_rate_ned_mps2.allFinite(),
          "the current is not finite");
  require(!std::isnan(water.sea_surface_z_m), "the sea surface is not a number");
  vehicles_.at(index).water = water;
}

void VehicleWorld::set_model(std::size_t index, std::shared_ptr<const Model> model) {
  require(model != nullptr, "a vehicle needs a model");
  Vehicle& v = vehicles_.at(index);
  v.model = std::move(model);
  scale_mass(v.body, v.model->parameters(), 1);
  longest_hull_m_ = std::max(longest_hull_m_, v.model->parameters().hull.length_m);
}

void VehicleWorld::step(double step_s) {
  require_in_range(step_s, 1e-6, kLongestStep_s, "physics step", "s");
  links_.clear();
  contacts_.clear();
  solve_free_motions(step_s);
  find_links(step_s);
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    if (!vehicles_[i].diverged) attach_contacts(i, step_s);
  }
  if (!contacts_.empty() || !links_.empty()) solve_contacts(step_s);
  note_what_touches();
  note_what_links_did();
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    if (!vehicles_[i].diverged) take_result(i, step_s);
  }
  dJointGroupEmpty(ode_->contacts());
}

// Solves each vehicle's motion without contacts, and finds its contacts with the seabed where that motion
// leads.
void VehicleWorld::solve_free_motions(double step_s) {
  constexpr std::size_t kAtOnce = 64;  // vehicles for each task of a thread
  const std::size_t count = vehicles_.size();
  for_each_((count + kAtOnce - 1) / kAtOnce, [&](std::size_t chunk) {
    const std::size_t end = std::min(count, (chunk + 1) * kAtOnce);
    for (std::size_t i = chunk * kAtOnce; i < end; ++i) {
      Vehicle& v = vehicles_[i];
      if (!v.diverged) solve_free_motion(v, step_s);
      if (!v.diverged && seabed_) find_seabed_contacts(v, step_s);
    }
  });
}

// Marks a vehicle whose solution is not finite as diverged: such numbers would make ODE abort.
void VehicleWorld::solve_free_motion(Vehicle& v, double step_s) {
  v.next = rk4_step(*v.model, v.state, v.command, v.water, step_s);
  v.linked = false;
  v.mass_scale = 1;
  v.seabed_contacts.clear();
  if (is_finite(v.next)) return;
  v.diverged = true;
  v.seabed_force.setZero();
  v.link_force.setZero();
  v.touches_vehicle = false;
}

void VehicleWorld::find_seabed_contacts(Vehicle& v, double step_s) {
  const VehicleState reached = moved_freely(*v.model, v.state, v.next, step_s);
  find_contacts(v.model->parameters().hull, reached.position_ned_m, reached.orientation, *seabed_,
                kContactMargin, v.seabed_contacts);
}

// Steps ODE with the bodies that have a contact; the others keep their free motion.
void VehicleWorld::solve_contacts(double step_s) {
  prepare_ode_in_this_thread();
  for (Vehicle& v : vehicles_) {
    if (v.diverged || !v.takes_part()) continue;
    dBodyEnable(v.body);
    const Quaternion& q = v.linked ? v.reached.orientation : v.state.orientation;
    push_to_velocity(v.body, *v.model, v.state, v.next, q, v.mass_scale, step_s);
  }
  for (Contact& contact : contacts_) dJointSetFeedback(contact.joint, &contact.feedback);
  for (Link& link : links_) attach_link(link, step_s);
  ensure(dWorldStep(ode_->world(), step_s) != 0, "ODE is out of memory");
}

void VehicleWorld::attach_contacts(std::size_t index, double step_s) {
  const Vehicle& v = vehicles_[index];
  if (v.seabed_contacts.empty()) return;
  if (!v.linked) write_body(v.body, *v.model, v.state);
  const Motion now = motion_of_cg(*v.model, v.state), free = motion_of_cg(*v.model, v.next);
  const Vec3 cg_reached = now.position + step_s * free.velocity;
  for (const HullContact& c : v.seabed_contacts) {
    // The gap after the step is to be 0 or more: gap + h n . (v - v_rk4), at the point of contact.
    const Vec3 arm = c.point_ned_m - cg_reached;
    const double free_speed = c.normal_ned.dot(free.velocity + free.angular_velocity.cross(arm));
    const double min_speed = std::min(free_speed - c.gap_m / step_s, kFastestPushOut);
    const Vec3 body_at = v.linked ? cg_reached : now.position;
    const dContact contact = ode_contact(c.normal_ned, body_at + arm, -min_speed, friction_);
    const dJointID joint = dJointCreateContact(ode_->world(), ode_->contacts(), &contact);
    dJointAttach(joint, v.body, nullptr);
    contacts_.push_back({index, joint});
  }
}

void VehicleWorld::note_what_touches() {
  for (Vehicle& v : vehicles_) v.touches = false;
  for (const Contact& c : contacts_) {
    if (vector_from(c.feedback.f1).norm() > kMinForce) vehicles_[c.vehicle].touches = true;
  }
}

void VehicleWorld::take_result(std::size_t index, double step_s) {
  Vehicle& v = vehicles_[index];
  v.seabed_force.setZero();
  if (v.touches) {
    take_grounded(v, step_s);
  } else if (!v.link_force.isZero(0)) {
    take_struck(index, step_s);
  }
  if (v.takes_part()) {
    dBodyDisable(v.body);
    if (v.linked) scale_mass(v.body, v.model->parameters(), 1);
    v.diverged = !is_finite(v.next);
  }
  if (!v.diverged) v.state = v.next;
}

void VehicleWorld::take_grounded(Vehicle& v, double step_s) {
  const Vec3 velocity = vector_from(dBodyGetLinearVel(v.body)),
             spin = vector_from(dBodyGetAngularVel(v.body));
  VehicleState touching =
      moved(*v.model, v.state, {motion_of_cg(*v.model, v.state).position, velocity, spin}, step_s);
  touching.actuators = v.next.actuators;
  // Force of the seabed by the vehicle's own equations:
  //
  //   M (nu - nu_rk4) / h
  const Vec6 impulse = v.model->mass() * (touching.velocity_body - v.next.velocity_body);
  v.seabed_force = v.next.orientation * Vec3(impulse.head<3>() / step_s) - v.link_force;
  v.next = touching;
}

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

// Returns a tether's end in the world frame, at the vehicle's present pose or at the one to which its free
// velocity leads.
Vec3 VehicleWorld::end_of(const std::optional<std::size_t>& vehicle, const Vec3& attached_at_m,
                          bool when_reached) const {
  if (!vehicle) return attached_at_m;
  const Vehicle& v = vehicles_[*vehicle];
  const VehicleState& state = when_reached ? v.reached : v.state;
  return state.position_ned_m + state.orientation * attached_at_m;
}

// Pairs come in ascending order, then tethers, so that the order of ODE's joints, and with it the result, is
// that of the indices.
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
    set_motion_of_cg(there, *v.model, motion_of_cg(*v.model, v.state));
    const Vec3 cg = motion_of_cg(*v.model, v.reached).position;
    write_body(v.body, *v.model, there);
    dBodySetPosition(v.body, cg.x(), cg.y(), cg.z());
  }
}

void VehicleWorld::find_meetings(double step_s) {
  positions_.clear();
  for (const Vehicle& v : vehicles_)
    positions_.push_back(v.diverged ? v.state.position_ned_m : v.next.position_ned_m);
  // The difference of `next` and `reached`, half an acceleration times the step squared, is less than the
  // margin.
  for (const auto& [i, k] : neighbours_.within(longest_hull_m_ + 4 * kContactMargin, positions_)) {
    Vehicle &a = vehicles_[i], &b = vehicles_[k];
    if (a.diverged || b.diverged) continue;
    a.reached = moved_freely(*a.model, a.state, a.next, step_s);
    b.reached = moved_freely(*b.model, b.state, b.next, step_s);
    const double time =
        find_first_touch(path_of(a.model->parameters().hull, a.state, a.reached),
                         path_of(b.model->parameters().hull, b.state, b.reached), kContactMargin, meeting_);
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
      is_whole = is_whole && !v.diverged;
      if (!v.diverged) v.reached = moved_freely(*v.model, v.state, v.next, step_s);
    }
    if (!is_whole) continue;
    const Vec3 from = end_of(t.vehicle, t.attached_at_m, true),
               to = end_of(t.to_vehicle, t.to_attached_at_m, true);
    const double distance = (to - from).norm(), slack = t.length_m - distance;
    if (slack > kContactMargin || distance < kMinDistance) continue;
    links_.push_back({t.vehicle, t.to_vehicle, from, (to - from) / distance, slack, 0, i});
  }
}

// Scales the mass of ODE's body so that it responds at its closest link as the vehicle with its added mass
// does.
void VehicleWorld::take_scale_of(Vehicle& v, const Link& link) {
  if (v.linked && v.closest_link_m <= link.gap_m) return;
  v.linked = true;
  v.closest_link_m = link.gap_m;
  v.mass_scale = scale_of_mass_at(*v.model, v.reached, link.point, link.normal);
}

// Joins the bodies of a link by a contact that limits their approach. With the gap g at the end of the step
// when the bodies move at their free velocities and u their free speed of separation along the normal, the
// speed must be at least u - g / h, so that the gap does not become negative.
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
