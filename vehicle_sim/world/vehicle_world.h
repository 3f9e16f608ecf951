// SPDX-License-Identifier: BSD-3-Clause
// Vehicles as rigid bodies in an ODE world, free in the water and in contact with the seabed, with each other
// and with tethers.
//
// Formulation: each step solves our own equations of motion (equations_of_motion.h) by Runge-Kutta; the force
// that takes the ODE body to that velocity, M_ode (v_rk4 - v) / h, is applied at its centre of gravity
// together with the contacts, and ODE steps (dWorldStep, which is exact and draws no random numbers). A free
// vehicle takes the Runge-Kutta state whole, so free flight does not depend on ODE, which sees only those in
// contact. In contact with the ground it takes ODE's velocity, and its pose from the old pose and that
// velocity, x + h v: then a vehicle that rests, rests (with x_rk4 + h (v - v_rk4) friction let it creep
// uphill by half a step's acceleration). M_ode is the dry mass plus the heave added mass, the inertia
// likewise. Contacts are looked for at the pose the free velocity leads to, and limit the velocity so that
// none is in the ground after the step: no bounce, Coulomb friction (a pyramid, up to 1.4 times stronger
// along its edges; along the hull, where the true mass is less than M_ode, it holds half as much). Accuracy:
// a resting vehicle is held by its weight less its buoyancy to 1e-3; it stays less than 1 cm in even ground
// at steps to 20 ms.
//
// Two vehicles: contacts likewise (vehicle_contact.h), without friction or bounce. There M_ode is scaled so
// that ODE's body gives way at the point of contact as the vehicle with all its added mass does; ODE then
// finds the impulse, and each vehicle takes it by its own equations (body_motion.h), so that the momentum of
// vehicles and water is conserved. With more contacts than one on a vehicle the scale is that of the closest,
// and the others close or open in the next steps. A tether is the same contact with the distance turned
// round: it holds its two ends within its length, pulls and never pushes, weighs nothing, has no drag and
// does not stretch.
//
// Left out: soft sediment, the changed added mass near the ground and near others. Coordinates are local to
// the scenario: ODE's steps lose 1e-5 m far from the origin (1e6 m). Threads: one world in one thread at a
// time; any number of worlds in as many threads, with equal results.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "core/archive.h"
#include "core/for_each.h"
#include "core/frames.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/world/neighbours.h"
#include "vehicle_sim/world/seabed.h"
#include "vehicle_sim/world/seabed_contact.h"
#include "vehicle_sim/world/vehicle_contact.h"

struct dxBody;  // ODE's, as in <ode/common.h>

namespace halocline::vehicle_sim {

class OdeWorld;

// A rope between two vehicles of a world, or a vehicle and a point that is fixed.
struct Tether {
  std::size_t vehicle = 0;                // index
  Vec3 attached_at_m = Vec3::Zero();      // from CO, body frame
  std::optional<std::size_t> to_vehicle;  // another one; empty: the other end is fixed
  Vec3 to_attached_at_m = Vec3::Zero();   // its body frame; of a fixed end, the world frame (NED)
  double length_m = 1;                    // above 0
};

class VehicleWorld {
 public:
  // A `seabed` that is null is water without a bottom. `friction`: Coulomb's coefficient of hull on seabed, 0
  // or above (0.5: smooth plastic on sand, a middle value).
  // `for_each` shares what each vehicle does by itself among threads; the result is the same bit by bit.
  explicit VehicleWorld(std::shared_ptr<const Seabed> seabed, double friction = kDefaultFriction,
                        ForEach for_each = one_after_the_other);
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

  // Another model in the place of a vehicle's, from the next step on: a leak makes it heavier. The hull must
  // be the same.
  void set_model(std::size_t index, std::shared_ptr<const Model> model);

  // Advances all vehicles by `step_s`, above 0 and at most kLongestStep_s.
  void step(double step_s);

  const VehicleState& state(std::size_t index) const { return vehicles_[index].state; }
  const Model& model(std::size_t index) const { return *vehicles_[index].model; }

  // Where the vehicles are and what the last step did; not their models, commands and water, which are set
  // anew.
  void archive(Archive& a);

  // Adds a tether between vehicles that are there already and returns its index. It may be stretched at
  // first: its ends then approach at up to 0.2 m/s.
  std::size_t add(const Tether& tether);

  // How far apart a tether's ends are, and its pull in the last step, newtons, 0 or above.
  double tether_distance_m(std::size_t tether) const;
  double tether_pull_n(std::size_t tether) const { return tethers_[tether].pull_n; }

  // Sum of the forces of other hulls and of tethers in the last step, newtons, world frame.
  const Vec3& link_force_ned_n(std::size_t index) const { return vehicles_[index].link_force; }
  // True when it touched another vehicle in the last step.
  bool touches_vehicle(std::size_t index) const { return vehicles_[index].touches_vehicle; }

  // Sum of the ground's forces on the vehicle in the last step, newtons, world frame; zero when it touched
  // nothing.
  const Vec3& seabed_force_ned_n(std::size_t index) const { return vehicles_[index].seabed_force; }

  // True once a vehicle's equations gave a number that is not finite: it stays where it was last and moves no
  // more.
  bool has_diverged(std::size_t index) const { return vehicles_[index].diverged; }

 private:
  struct Contact;
  struct Link;
  struct Vehicle {
    std::shared_ptr<const Model> model;
    VehicleState state;
    VehicleState next = {};  // the free solution of this step
    ActuatorValues command = {};
    Water water = {};
    dxBody* body = nullptr;  // owned by the ODE world
    Vec3 seabed_force = Vec3::Zero();
    Vec3 link_force = Vec3::Zero();
    VehicleState reached = {};     // where the free velocity leads; of those that have a link
    double closest_link_m = 0;     // gap
    double mass_scale = 1;         // of M_ode in this step
    bool linked = false;           // has a link in this step
    bool touches = false;          // the ground, in the last step
    bool touches_vehicle = false;  // in the last step
    bool diverged = false;
    std::vector<HullContact> ground = {};  // where the hull would touch it in this step

    bool takes_part() const { return linked || !ground.empty(); }  // in ODE's step
  };
  struct TiedTether {
    Tether tether;
    double pull_n = 0;
  };

  void solve_free_motions(double step_s);
  static void solve_free_motion(Vehicle& vehicle, double step_s);
  void look_for_ground(Vehicle& vehicle, double step_s);
  void solve_contacts(double step_s);
  void attach_contacts(std::size_t index, double step_s);
  void find_links(double step_s);
  void find_meetings(double step_s);
  void find_taut_tethers(double step_s);
  void attach_link(Link& link, double step_s);
  static void take_scale_of(Vehicle& vehicle, const Link& link);
  Vec3 end_of(const std::optional<std::size_t>& vehicle, const Vec3& attached_at_m, bool when_reached) const;
  void note_what_touches();
  void note_what_links_did();
  void take_result(std::size_t index, double step_s);
  void take_struck(std::size_t index, double step_s);
  void take_grounded(Vehicle& vehicle, double step_s);

  std::shared_ptr<const Seabed> seabed_;
  double friction_;
  ForEach for_each_;
  std::unique_ptr<OdeWorld> ode_;
  std::vector<Vehicle> vehicles_;
  std::vector<TiedTether> tethers_;
  double longest_hull_m_ = 0;
  Neighbours neighbours_;
  std::vector<VehicleContact> meeting_;  // of find_meetings
  std::vector<Vec3> positions_;          // of find_meetings
  std::vector<Contact> contacts_;        // of this step, with the ground
  std::vector<Link> links_;              // of this step, with others and tethers
};

}  // namespace halocline::vehicle_sim
