// SPDX-License-Identifier: BSD-3-Clause
// World of vehicles as rigid bodies, free in the water and in contact with the seabed, with each other and
// with tethers. Contacts are solved by the Open Dynamics Engine (ODE).
//
// Each step solves the equations of motion (equations_of_motion.h) by Runge-Kutta. For vehicles in contact,
// the force
//
//   F = M_ode (v_rk4 - v) / h
//
// that takes the ODE body to the velocity of that solution is applied at its centre of gravity together with
// the contacts, and ODE steps (dWorldStep, which is exact and draws no random numbers). M_ode is the dry mass
// plus the added mass of heave, and the inertia likewise. A vehicle without contacts takes the Runge-Kutta
// state as it is, so free motion does not depend on ODE.
//
// Seabed: a vehicle takes ODE's velocity, and its pose follows from the old pose and that velocity, x + h v.
// A vehicle at rest then stays at rest (with x_rk4 + h (v - v_rk4) friction would let it creep uphill by half
// a step's acceleration). Contacts are found at the pose to which the free velocity leads. They limit the
// velocity so that no point is below the seabed after the step: no bounce, Coulomb friction. Friction is a
// pyramid, up to 1.4 times stronger along its edges; along the hull, where the true mass is less than M_ode,
// it holds half as much. Accuracy: the contact force on a vehicle at rest is its weight less its buoyancy to
// 1e-3; it penetrates even seabed by less than 1 cm at steps up to 20 ms.
//
// Other vehicles: contacts likewise (vehicle_contact.h), without friction or bounce. M_ode is scaled so that
// ODE's body responds at the point of contact as the vehicle with all its added mass does. ODE then finds the
// impulse, and each vehicle takes it by its own equations (body_motion.h), so that the momentum of vehicles
// and water is conserved. With several contacts on a vehicle the scale is that of the closest, and the others
// close or open in the next steps. A tether is the same contact with the distance reversed: it keeps its two
// ends within its length, pulls and never pushes, and has no weight, no drag and no stretch.
//
// Left out: soft sediment, the change of added mass near the seabed and near other hulls. Coordinates are
// local to the scenario: ODE's steps lose 1e-5 m far from the origin (1e6 m). Threads: one world in one
// thread at a time; any number of worlds in as many threads, with equal results.
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

struct dxBody;  // declared in <ode/common.h>

namespace halocline::vehicle_sim {

class OdeWorld;

// Tether between two vehicles of a world, or between a vehicle and a fixed point.
struct Tether {
  std::size_t vehicle = 0;                // index
  Vec3 attached_at_m = Vec3::Zero();      // from CO, body frame
  std::optional<std::size_t> to_vehicle;  // another vehicle; empty: the other end is fixed
  Vec3 to_attached_at_m = Vec3::Zero();   // in its body frame; for a fixed end, in the world frame (NED)
  double length_m = 1;                    // above 0
};

class VehicleWorld {
 public:
  // `seabed`: null is water without a bottom. `friction`: Coulomb's coefficient of hull on seabed, 0 or above
  // (0.5: smooth plastic on sand, a medium value). `for_each` distributes the work of each vehicle over
  // threads; the result is the same bit by bit.
  explicit VehicleWorld(std::shared_ptr<const Seabed> seabed, double friction = kDefaultFriction,
                        ForEach for_each = one_after_the_other);
  ~VehicleWorld();
  VehicleWorld(const VehicleWorld&) = delete;
  VehicleWorld& operator=(const VehicleWorld&) = delete;

  static constexpr double kDefaultFriction = 0.5;
  static constexpr double kLongestStep_s = 0.02;

  // Adds a vehicle and returns its index, counted from 0. `initial` must be finite, with a quaternion of unit
  // length to 1e-6.
  std::size_t add(std::shared_ptr<const Model> model, const VehicleState& initial);

  std::size_t size() const { return vehicles_.size(); }

  // Sets the command and the water of a vehicle from the next step on; both must be finite. The command is
  // limited to the model's ranges.
  void set_command(std::size_t index, const ActuatorValues& command);
  void set_water(std::size_t index, const Water& water);

  // Replaces a vehicle's model from the next step on, for example when a leak makes it heavier. The hull must
  // be the same.
  void set_model(std::size_t index, std::shared_ptr<const Model> model);

  // Advances all vehicles by `step_s`, above 0 and at most kLongestStep_s.
  void step(double step_s);

  const VehicleState& state(std::size_t index) const { return vehicles_[index].state; }
  const Model& model(std::size_t index) const { return *vehicles_[index].model; }

  // Archives the vehicles' states and the forces of the last step, without models, commands and water, which
  // the caller sets again.
  void archive(Archive& a);

  // Adds a tether between existing vehicles and returns its index. Its ends may be farther
  // apart than its length at first; they then approach at up to 0.2 m/s.
  std::size_t add(const Tether& tether);

  // Distance of a tether's ends, m, and its pull in the last step, N, 0 or above.
  double tether_distance_m(std::size_t tether) const;
  double tether_pull_n(std::size_t tether) const { return tethers_[tether].pull_n; }

  bool touches_vehicle(std::size_t index) const { return vehicles_[index].touches_vehicle; }

  // Sum of the seabed's forces on the vehicle in the last step, N, world frame; zero without contact.
  const Vec3& seabed_force_ned_n(std::size_t index) const { return vehicles_[index].seabed_force; }

  // True once the solution of a vehicle's equations was not finite: it then stays at its last position.
  bool has_diverged(std::size_t index) const { return vehicles_[index].diverged; }

 private:
  struct Contact;
  struct Link;
  struct Vehicle {
    std::shared_ptr<const Model> model;
    VehicleState state;
    VehicleState next = {};  // free solution of this step
    ActuatorValues command = {};
    Water water = {};
    dxBody* body = nullptr;  // owned by the ODE world
    Vec3 seabed_force = Vec3::Zero();
    Vec3 link_force = Vec3::Zero();
    VehicleState reached = {};     // pose to which the free velocity leads; valid with a link
    double closest_link_m = 0;     // gap of its closest link
    double mass_scale = 1;         // scale of M_ode in this step
    bool linked = false;           // has a link in this step
    bool touches = false;          // touched the seabed in the last step
    bool touches_vehicle = false;  // touched another vehicle in the last step
    bool diverged = false;
    std::vector<HullContact> seabed_contacts = {};  // in this step

    bool takes_part() const { return linked || !seabed_contacts.empty(); }  // true in ODE's step
  };
  struct TiedTether {
    Tether tether;
    double pull_n = 0;
  };

  void solve_free_motions(double step_s);
  static void solve_free_motion(Vehicle& vehicle, double step_s);
  void find_seabed_contacts(Vehicle& vehicle, double step_s);
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
  std::vector<VehicleContact> meeting_;  // work space of find_meetings
  std::vector<Vec3> positions_;          // work space of find_meetings
  std::vector<Contact> contacts_;        // contacts with the seabed in this step
  std::vector<Link> links_;              // links to other hulls and by tethers in this step
};

}  // namespace halocline::vehicle_sim
