// Vehicles as rigid bodies in an ODE world, free in the water and in contact with the seabed.
//
// Formulation: each step solves our own equations of motion (equations_of_motion.h) by Runge-Kutta; the force
// that takes the ODE body to that velocity, M_ode (v_rk4 - v) / h, is applied at its centre of gravity
// together with the contacts, and ODE steps (dWorldStep, which is exact and draws no random numbers). A free
// vehicle takes the Runge-Kutta state whole, so free flight does not depend on ODE. In contact it takes ODE's
// velocity, and its pose from the old pose and that velocity, x + h v: then a vehicle that rests, rests (with
// x_rk4 + h (v - v_rk4) friction let it creep uphill by half a step's acceleration). M_ode is the dry mass
// plus the heave added mass, the inertia likewise. Contacts are looked for at the pose the free velocity
// leads to, and limit the velocity so that none is in the ground after the step: no bounce, Coulomb friction
// (a pyramid, up to 1.4 times stronger along its edges; along the hull, where the true mass is less than
// M_ode, it holds half as much). Accuracy: a resting vehicle is held by its weight less its buoyancy to 1e-3;
// it stays less than 1 cm in even ground at steps to 20 ms. Left out: soft sediment, contact between
// vehicles, the changed added mass near the ground. Coordinates are local to the scenario: ODE's steps lose
// 1e-5 m far from the origin (1e6 m). Threads: one world in one thread at a time; any number of worlds in as
// many threads, with equal results.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "vehicle_sim/seabed.h"
#include "vehicle_sim/seabed_contact.h"
#include "vehicle_sim/vehicle_state.h"

struct dxBody;  // ODE's, as in <ode/common.h>

namespace halocline::vehicle_sim {

class OdeWorld;

class VehicleWorld {
 public:
  // A `seabed` that is null is water without a bottom. `friction`: Coulomb's coefficient of hull on seabed, 0
  // or above (0.5: smooth plastic on sand, a middle value).
  explicit VehicleWorld(std::shared_ptr<const Seabed> seabed, double friction = kDefaultFriction);
  ~VehicleWorld();
  VehicleWorld(const VehicleWorld&) = delete;
  VehicleWorld& operator=(const VehicleWorld&) = delete;

  static constexpr double kDefaultFriction = 0.5;
  static constexpr double kLongestStep_s = 0.02;

  // Adds a vehicle and returns its index, counted from 0. `initial` finite, its quaternion of unit length to
  // 1e-6.
  std::size_t add(std::shared_ptr<const Model> model, const VehicleState& initial);

  std::size_t size() const { return vehicles_.size(); }

  // What a vehicle does and meets from the next step on; finite. The command is held to the model's limits.
  void set_command(std::size_t index, const ActuatorValues& command);
  void set_water(std::size_t index, const Water& water);

  // Advances all vehicles by `step_s`, above 0 and at most kLongestStep_s.
  void step(double step_s);

  const VehicleState& state(std::size_t index) const { return vehicles_[index].state; }
  const Model& model(std::size_t index) const { return *vehicles_[index].model; }

  // Sum of the ground's forces on the vehicle in the last step, newtons, world frame; zero when it touched
  // nothing.
  const Vec3& seabed_force_ned_n(std::size_t index) const { return vehicles_[index].seabed_force; }

  // True once a vehicle's equations gave a number that is not finite: it stays where it was last and moves no
  // more.
  bool is_lost(std::size_t index) const { return vehicles_[index].lost; }

 private:
  struct Contact;
  struct Vehicle {
    std::shared_ptr<const Model> model;
    VehicleState state;
    VehicleState next = {};  // the free solution of this step
    ActuatorValues command = {};
    Water water = {};
    dxBody* body = nullptr;  // owned by the ODE world
    Vec3 seabed_force = Vec3::Zero();
    bool touches = false;  // in the last step
    bool lost = false;
  };

  void aim_body_at_free_solution(Vehicle& vehicle, double step_s);
  void attach_contacts(std::size_t index, double step_s);
  void note_what_touches();
  void take_result(Vehicle& vehicle, double step_s);

  std::shared_ptr<const Seabed> seabed_;
  double friction_;
  std::unique_ptr<OdeWorld> ode_;
  std::vector<Vehicle> vehicles_;
  std::vector<HullContact> found_;  // working storage of attach_contacts
  std::vector<Contact> contacts_;   // of this step
};

}  // namespace halocline::vehicle_sim
