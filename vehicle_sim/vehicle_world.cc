#include "vehicle_sim/vehicle_world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"
#include "vehicle_sim/equations_of_motion.h"
#include "vehicle_sim/ode_handles.h"

namespace halocline::vehicle_sim {
namespace {

constexpr double kContactMargin =
    0.05;  // m: contacts this far off are watched, should others push towards them
constexpr double kFastestPushOut = 0.2;  // m/s: a hull found in the ground is moved out no faster
constexpr double kUnitTolerance = 1e-6;  // of a quaternion's length
constexpr double kLeastForce = 1e-9;     // N: below is no contact

// The motion of the centre of gravity, world frame.
struct Motion {
  Vec3 position, velocity, angular_velocity;
};

Motion motion_of_cg(const Model& model, const VehicleState& s) {
  const Vec3& r = model.parameters().center_of_gravity_m;
  const Vec3 v = s.linear_velocity_body_mps(), w = s.angular_velocity_body_radps();
  return {s.position_ned_m + s.orientation * r, s.orientation * Vec3(v + w.cross(r)), s.orientation * w};
}

// Writes a motion of the centre of gravity into the state, whose orientation is already set.
void set_motion_of_cg(VehicleState& s, const Model& model, const Motion& cg) {
  const Vec3& r = model.parameters().center_of_gravity_m;
  const Quaternion to_body = s.orientation.conjugate();
  const Vec3 w = to_body * cg.angular_velocity;
  s.position_ned_m = cg.position - s.orientation * r;
  s.velocity_body << to_body * cg.velocity - w.cross(r), w;
}

// q turned by the rotation vector `angle` of the world frame, radians.
Quaternion turned(const Quaternion& q, const Vec3& angle) {
  const double size = angle.norm();
  if (size == 0) return q;
  return (Quaternion(Eigen::AngleAxisd(size, angle / size)) * q).normalized();
}

// The state after a step of `step_s` at the velocities of `cg`, from its position and the state's
// orientation.
VehicleState moved(const Model& model, const VehicleState& from, const Motion& cg, double step_s) {
  VehicleState to = from;
  to.orientation = turned(from.orientation, step_s * cg.angular_velocity);
  set_motion_of_cg(to, model, {cg.position + step_s * cg.velocity, cg.velocity, cg.angular_velocity});
  return to;
}

Vec3 vector_from(const dReal* v) { return {v[0], v[1], v[2]}; }

// ODE's mass: dry mass and inertia with the added mass of heave and of rotation. What contact feels; see the
// header.
dMass ode_mass(const ModelParameters& p) {
  dMass mass;
  const Mat3& inertia = p.inertia_kg_m2;
  dMassSetParameters(&mass, p.mass_kg + p.added_mass(2, 2), 0, 0, 0, inertia(0, 0) + p.added_mass(3, 3),
                     inertia(1, 1) + p.added_mass(4, 4), inertia(2, 2) + p.added_mass(5, 5), inertia(0, 1),
                     inertia(0, 2), inertia(1, 2));
  return mass;
}

void write_body(dBodyID body, const Model& model, const VehicleState& state) {
  const Motion cg = motion_of_cg(model, state);
  const Quaternion& q = state.orientation;
  const dQuaternion orientation = {q.w(), q.x(), q.y(), q.z()};
  dBodySetPosition(body, cg.position.x(), cg.position.y(), cg.position.z());
  dBodySetQuaternion(body, orientation);
  dBodySetLinearVel(body, cg.velocity.x(), cg.velocity.y(), cg.velocity.z());
  dBodySetAngularVel(body, cg.angular_velocity.x(), cg.angular_velocity.y(), cg.angular_velocity.z());
}

dBodyID make_body(dWorldID world, const Model& model, const VehicleState& state) {
  const dBodyID body = dBodyCreate(world);
  const dMass mass = ode_mass(model.parameters());
  dBodySetMass(body, &mass);
  dBodySetGyroscopicMode(body, 0);
  dBodySetFiniteRotationMode(body, 1);
  dBodySetAutoDisableFlag(body, 0);
  write_body(body, model, state);
  return body;
}

// A contact that lets the hull's point approach the plane by `closing_speed` at most (negative: it must
// part).
dContact ode_contact(const HullContact& hull_contact, const Vec3& point, double closing_speed,
                     double friction) {
  dContact contact = {};
  contact.surface.mode = dContactApprox1 | dContactMotionN;
  contact.surface.mu = friction;
  contact.surface.motionN = -closing_speed;
  for (int k = 0; k < 3; ++k) {
    contact.geom.pos[k] = point[k];
    contact.geom.normal[k] = hull_contact.normal_ned[k];
  }
  return contact;
}

}  // namespace

struct VehicleWorld::Contact {
  std::size_t vehicle;
  dJointID joint;
  dJointFeedback feedback = {};
};

VehicleWorld::VehicleWorld(std::shared_ptr<const Seabed> seabed, double friction)
    : seabed_(std::move(seabed)), friction_(friction), ode_(std::make_unique<OdeWorld>()) {
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

void VehicleWorld::step(double step_s) {
  require_in_range(step_s, 1e-6, kLongestStep_s, "physics step", "s");
  prepare_ode_in_this_thread();
  dJointGroupEmpty(ode_->contacts());
  contacts_.clear();
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    if (vehicles_[i].lost) continue;
    aim_body_at_free_solution(vehicles_[i], step_s);
    if (seabed_ && !vehicles_[i].lost) attach_contacts(i, step_s);
  }
  for (Contact& contact : contacts_) dJointSetFeedback(contact.joint, &contact.feedback);
  ensure(dWorldStep(ode_->world(), step_s) != 0, "ODE is out of memory");
  note_what_touches();
  for (Vehicle& vehicle : vehicles_) {
    if (!vehicle.lost) take_result(vehicle, step_s);
  }
}

// Solves the free motion and gives the body the force that takes it there. Nothing that is not finite reaches
// ODE, which would abort.
void VehicleWorld::aim_body_at_free_solution(Vehicle& v, double step_s) {
  v.next = rk4_step(*v.model, v.state, v.command, v.water, step_s);
  if (!is_finite(v.next)) {
    v.lost = true;
    v.seabed_force.setZero();
    dBodyDisable(v.body);
    return;
  }
  const ModelParameters& p = v.model->parameters();
  const Motion now = motion_of_cg(*v.model, v.state), then = motion_of_cg(*v.model, v.next);
  const Vec3 force = (p.mass_kg + p.added_mass(2, 2)) / step_s * (then.velocity - now.velocity);
  const Mat3 inertia = p.inertia_kg_m2 + Mat3(p.added_mass.diagonal().tail<3>().asDiagonal());
  const Vec3 spin_up = (then.angular_velocity - now.angular_velocity) / step_s;
  const Vec3 torque = v.state.orientation * (inertia * (v.state.orientation.conjugate() * spin_up));
  dBodySetForce(v.body, force.x(), force.y(), force.z());
  dBodySetTorque(v.body, torque.x(), torque.y(), torque.z());
}

void VehicleWorld::attach_contacts(std::size_t index, double step_s) {
  const Vehicle& v = vehicles_[index];
  const Motion now = motion_of_cg(*v.model, v.state), free = motion_of_cg(*v.model, v.next);
  const VehicleState reached =
      moved(*v.model, v.state, {now.position, free.velocity, free.angular_velocity}, step_s);
  find_contacts(v.model->parameters().hull, reached.position_ned_m, reached.orientation, *seabed_,
                kContactMargin, found_);
  const Vec3 cg_reached = now.position + step_s * free.velocity;
  for (const HullContact& c : found_) {
    // After the step the gap is gap + h n . (v - v_rk4) at the point; it is to be 0 or more.
    const Vec3 arm = c.point_ned_m - cg_reached;
    const double free_speed = c.normal_ned.dot(free.velocity + free.angular_velocity.cross(arm));
    const double least_speed = std::min(free_speed - c.gap_m / step_s, kFastestPushOut);
    const dContact contact = ode_contact(c, now.position + arm, -least_speed, friction_);
    const dJointID joint = dJointCreateContact(ode_->world(), ode_->contacts(), &contact);
    dJointAttach(joint, v.body, nullptr);
    contacts_.push_back({index, joint});
  }
}

void VehicleWorld::note_what_touches() {
  for (Vehicle& v : vehicles_) v.touches = false;
  for (const Contact& c : contacts_) {
    if (vector_from(c.feedback.f1).norm() > kLeastForce) vehicles_[c.vehicle].touches = true;
  }
}

void VehicleWorld::take_result(Vehicle& v, double step_s) {
  v.seabed_force.setZero();
  if (v.touches) {
    const Vec3 velocity = vector_from(dBodyGetLinearVel(v.body)),
               spin = vector_from(dBodyGetAngularVel(v.body));
    VehicleState touching =
        moved(*v.model, v.state, {motion_of_cg(*v.model, v.state).position, velocity, spin}, step_s);
    touching.actuators = v.next.actuators;
    // What the ground did, as our own equations see it: M (nu - nu_rk4) / h.
    const Vec6 impulse = v.model->mass() * (touching.velocity_body - v.next.velocity_body);
    v.seabed_force = v.next.orientation * Vec3(impulse.head<3>() / step_s);
    v.next = touching;
    v.lost = !is_finite(touching);
  }
  if (v.lost) return dBodyDisable(v.body);
  v.state = v.next;
  write_body(v.body, *v.model, v.state);
}

}  // namespace halocline::vehicle_sim
