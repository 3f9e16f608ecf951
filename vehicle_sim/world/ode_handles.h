// SPDX-License-Identifier: BSD-3-Clause
// Owners of the handles of the Open Dynamics Engine (ODE), for vehicle_world.cc alone.
//
// ODE keeps global tables, which are set up once in the process before the first world. Each world steps by a
// threading implementation of its own, in the calling thread: worlds that share ODE's default one crash when
// several threads step them.
#pragma once

#include <ode/ode.h>

namespace halocline::vehicle_sim {

// World without gravity (the weight is in the equations of motion), with a group for the contacts of one
// step.
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

// Sets up ODE's tables for the calling thread; must be called before a world steps. Cheap after the first
// call.
void prepare_ode_in_this_thread();

}  // namespace halocline::vehicle_sim
