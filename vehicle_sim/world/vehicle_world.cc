#include "vehicle_sim/world/vehicle_world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"
#include "vehicle_sim/dynamics/equations_of_motion.h"
#include "vehicle_sim/world/ode_bodies.h"

namespace halocline::vehicle_sim {
namespace {

constexpr double kUnitTolerance = 1e-6;  // of a quaternion's length
constexpr double kMinForce = 1e-9;       // N: below is no contact

}  // namespace

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
  require_in_range(initial.orientation.norm(), 1 - kUnitTolerance, 1 + kUnitTolerance,
                   "length of the quaternion");
  Vehicle vehicle{.model = std::move(model), .state = initial};
  vehicle.state.orientation.normalize();
  vehicle.body = make_body(ode_->world(), *vehicle.model, vehicle.state);
  dBodyDisable(vehicle.body);
  longest_hull_m_ = std::max(longest_hull_m_, vehicle.model->parameters().hull.length_m);
  vehicles_.push_back(std::move(vehicle));
  return vehicles_.size() - 1;
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
    if (!vehicles_[i].lost) attach_contacts(i, step_s);
  }
  if (!contacts_.empty() || !links_.empty()) solve_contacts(step_s);
  note_what_touches();
  note_what_links_did();
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    if (!vehicles_[i].lost) take_result(i, step_s);
  }
  dJointGroupEmpty(ode_->contacts());
}

// Each vehicle by itself: its motion without contacts, and the ground where that leads.
void VehicleWorld::solve_free_motions(double step_s) {
  constexpr std::size_t kAtOnce = 64;  // vehicles for each turn of a thread
  const std::size_t count = vehicles_.size();
  for_each_((count + kAtOnce - 1) / kAtOnce, [&](std::size_t chunk) {
    const std::size_t end = std::min(count, (chunk + 1) * kAtOnce);
    for (std::size_t i = chunk * kAtOnce; i < end; ++i) {
      Vehicle& v = vehicles_[i];
      if (!v.lost) solve_free_motion(v, step_s);
      if (!v.lost && seabed_) look_for_ground(v, step_s);
    }
  });
}

// Nothing that is not finite reaches ODE, which would abort.
void VehicleWorld::solve_free_motion(Vehicle& v, double step_s) {
  v.next = rk4_step(*v.model, v.state, v.command, v.water, step_s);
  v.linked = false;
  v.mass_scale = 1;
  v.ground.clear();
  if (is_finite(v.next)) return;
  v.lost = true;
  v.seabed_force.setZero();
  v.link_force.setZero();
  v.touches_vehicle = false;
}

void VehicleWorld::look_for_ground(Vehicle& v, double step_s) {
  const Motion now = motion_of_cg(*v.model, v.state), free = motion_of_cg(*v.model, v.next);
  const VehicleState reached =
      moved(*v.model, v.state, {now.position, free.velocity, free.angular_velocity}, step_s);
  find_contacts(v.model->parameters().hull, reached.position_ned_m, reached.orientation, *seabed_,
                kContactMargin, v.ground);
}

// Only what has a contact takes part; the others' free motion holds as it is.
void VehicleWorld::solve_contacts(double step_s) {
  prepare_ode_in_this_thread();
  for (Vehicle& v : vehicles_) {
    if (v.lost || !v.takes_part()) continue;
    dBodyEnable(v.body);
    aim_body_at_free_solution(v, step_s);
  }
  for (Contact& contact : contacts_) dJointSetFeedback(contact.joint, &contact.feedback);
  for (Link& link : links_) attach_link(link, step_s);
  ensure(dWorldStep(ode_->world(), step_s) != 0, "ODE is out of memory");
}

// Gives the body the force that takes it to the free solution.
void VehicleWorld::aim_body_at_free_solution(Vehicle& v, double step_s) {
  const ModelParameters& p = v.model->parameters();
  const Motion now = motion_of_cg(*v.model, v.state), then = motion_of_cg(*v.model, v.next);
  const Vec3 force =
      v.mass_scale * (p.mass_kg + p.added_mass(2, 2)) / step_s * (then.velocity - now.velocity);
  const Mat3 inertia = p.inertia_kg_m2 + Mat3(p.added_mass.diagonal().tail<3>().asDiagonal());
  const Vec3 spin_up = (then.angular_velocity - now.angular_velocity) / step_s;
  const Quaternion& q = v.linked ? v.reached.orientation : v.state.orientation;
  const Vec3 torque = v.mass_scale * (q * (inertia * (q.conjugate() * spin_up)));
  dBodySetForce(v.body, force.x(), force.y(), force.z());
  dBodySetTorque(v.body, torque.x(), torque.y(), torque.z());
}

void VehicleWorld::attach_contacts(std::size_t index, double step_s) {
  const Vehicle& v = vehicles_[index];
  if (v.ground.empty()) return;
  if (!v.linked) write_body(v.body, *v.model, v.state);
  const Motion now = motion_of_cg(*v.model, v.state), free = motion_of_cg(*v.model, v.next);
  const Vec3 cg_reached = now.position + step_s * free.velocity;
  for (const HullContact& c : v.ground) {
    // After the step the gap is gap + h n . (v - v_rk4) at the point; it is to be 0 or more.
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
    v.lost = !is_finite(v.next);
  }
  if (!v.lost) v.state = v.next;
}

void VehicleWorld::take_grounded(Vehicle& v, double step_s) {
  const Vec3 velocity = vector_from(dBodyGetLinearVel(v.body)),
             spin = vector_from(dBodyGetAngularVel(v.body));
  VehicleState touching =
      moved(*v.model, v.state, {motion_of_cg(*v.model, v.state).position, velocity, spin}, step_s);
  touching.actuators = v.next.actuators;
  // What the ground did, as our own equations see it: M (nu - nu_rk4) / h.
  const Vec6 impulse = v.model->mass() * (touching.velocity_body - v.next.velocity_body);
  v.seabed_force = v.next.orientation * Vec3(impulse.head<3>() / step_s) - v.link_force;
  v.next = touching;
}

}  // namespace halocline::vehicle_sim
