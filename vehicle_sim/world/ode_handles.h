// SPDX-License-Identifier: BSD-3-Clause
// Owners of the Open Dynamics Engine's handles, for vehicle_world.cc alone.
//
// ODE keeps global tables, set up once in the process before the first world. Each world steps by an
// implementation of its own, in the thread that calls: worlds that share ODE's default crash when stepped in
// several threads.
#pragma once

#include <ode/ode.h>

namespace halocline::vehicle_sim {

// A world without gravity (weight is in our equations) with a group for the contacts of one step.
class OdeWorld {
 public:
  OdeWorld();
  ~OdeWorld();
  OdeWorld(const OdeWorld&) = delete;
  OdeWorld& operator=(const OdeWorld&) = delete;

  dWorldID world() const { return world_; }
  dJointGroupID contacts() const { return contacts_; }

 private:
  dThreadingImplementationID threading_;
  dWorldID world_;
  dJointGroupID contacts_;
};

// Sets up ODE's tables for the calling thread; cheap after the first call. To be called before a world steps.
void prepare_ode_in_this_thread();

}  // namespace halocline::vehicle_sim
