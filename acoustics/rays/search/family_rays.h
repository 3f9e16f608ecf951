// SPDX-License-Identifier: BSD-3-Clause
// Rays of a link by their launch angle, as the smoothing of folds needs them: where they end at the
// receiver's range, and after which bounces.
//
// One object per link, not shared between threads.
#pragma once

#include <optional>

#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/fan_tracer.h"
#include "acoustics/rays/layered_rays.h"
#include "acoustics/rays/ray_trace.h"
#include "acoustics/rays/search/cycle_rays.h"

namespace halocline::acoustics {

// Counts of a ray's bounces. Rays of neighbouring launch angles and the same counts are of one family.
struct FamilyBounces {
  int surface = 0, bottom = 0;
  bool operator==(const FamilyBounces&) const = default;
};
inline FamilyBounces bounces_of(const Eigenray& path) { return {path.surface_bounces, path.bottom_bounces}; }

// A ray at the receiver's range.
struct FamilyRay {
  double theta = 0;  // launch angle, rad, positive down
  double off_m = 0;  // below the receiver
  double sine = 0;   // of its angle there; its sign is the same within a family or changes with the turn
  FamilyBounces bounces = {};
};

// The rays of one link.
class FamilyRays {
 public:
  virtual ~FamilyRays() = default;
  // The ray launched at `theta`; empty when it does not arrive.
  virtual std::optional<FamilyRay> at(double theta) = 0;
  // That ray as a diffuse eigenray without an amplitude.
  virtual std::optional<Eigenray> representative(double theta) const = 0;
};

// Rays of a level sea. Refers to the sea, which has to outlive this.
class LevelFamilyRays : public FamilyRays {
 public:
  LevelFamilyRays(const FlatSea& sea, const RayLink& link);
  std::optional<FamilyRay> at(double theta) override;
  std::optional<Eigenray> representative(double theta) const override;

 private:
  const FlatSea& sea_;
  RayLink link_;
  CycleRays rays_;
};

// Rays over a bottom that changes, or through water that does. Refers to what the sea refers to.
class ProfiledFamilyRays : public FamilyRays {
 public:
  ProfiledFamilyRays(const ProfiledSea& sea, const RayLink& link);
  std::optional<FamilyRay> at(double theta) override;
  std::optional<Eigenray> representative(double theta) const override;

 private:
  ArcTracer tracer_;
  FanTracer fan_;
};

}  // namespace halocline::acoustics
