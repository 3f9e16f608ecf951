// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/world/ode_handles.h"

#include "core/check.h"

namespace halocline::vehicle_sim {
namespace {

bool initialise_ode() {
  static const bool done = dInitODE2(0) != 0;  // once in the process, in whichever thread is first
  return done;
}

}  // namespace

void prepare_ode_in_this_thread() {
  thread_local const bool ready = initialise_ode() && dAllocateODEDataForThread(dAllocateMaskAll) != 0;
  ensure(ready, "ODE has no memory for this thread");
}

OdeWorld::OdeWorld() {
  prepare_ode_in_this_thread();
  threading_ = dThreadingAllocateSelfThreadedImplementation();
  world_ = dWorldCreate();
  contacts_ = dJointGroupCreate(0);
  dWorldSetStepThreadingImplementation(world_, dThreadingImplementationGetFunctions(threading_), threading_);
  dWorldSetGravity(world_, 0, 0, 0);
  dWorldSetAutoDisableFlag(world_, 0);
  dWorldSetDamping(world_, 0, 0);
}

OdeWorld::~OdeWorld() {
  dJointGroupDestroy(contacts_);
  dWorldDestroy(world_);
  dThreadingFreeImplementation(threading_);
}

}  // namespace halocline::vehicle_sim
