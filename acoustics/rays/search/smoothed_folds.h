// SPDX-License-Identifier: BSD-3-Clause
// Mean power of families of rays in a medium that is not perfect: finite at folds and cusps, and where rays
// turn at the receiver's depth.
//
// Model. Fine structure turns rays (acoustics/sea/fine_structure.h), so that a ray ends at its depth to
//   sigma_z = max(sqrt(mu r^3 / 3), sqrt(lambda r / (2 pi)) / 2),
// the second term half a Fresnel width; the movement of both ends adds its variance, and sigma_z is at most
// half of the depth of the water (our choice). The rays of one sequence of bounces form families. The mean
// power of a family is the integral over its launch angles
//   I = integral of f^2 xi_s / (xi_r r) N(zeta(theta) - z_r; sigma_z) dtheta
// with f the pressure factor of its bounces, xi = cos(angle) / c at source (s) and receiver (r), zeta the
// depth of arrival and N the normal density, reflected at surface and bottom so that no power leaves the
// water. Where zeta is straight over sigma_z, I is the power P of the ray, f^2 xi_s / (xi_r r |zeta'|).
//
// Each path has the part of I that lies between the folds beside it. It keeps P min(1, I / P)^2 and the rest
// of I is a window, one diffuse path of the family: what is left of a focus has lost its phase. A path keeps
// less than I near a fold so that its coherent share does not jump where the path ends (our choice). On the
// shadow side of a fold all of I is a window.
//
// Only where it matters. A ray that meets both surface and bottom of a level sea has no fold beside it. For
// the others two rays at 2 sigma_z to both sides tell e, by how much zeta is bent there in units of 2
// sigma_z. Below kStraight a path is left as it is, to the bit; the change is faded in up to kBent. It
// fades out, too, where sigma_z, depth or not, is from twice to once the Airy length of the fold, whose field
// (acoustics/math/fold_field.h) is wider then: in the mean over the family's power. Rays on the shadow side
// are sought among kMinShadowRays to kMaxShadowRays launch angles.
//
// Accuracy: 0.1 dB of the integral. Left out: shadows of folds narrower than those launch angles, kinks of
// the profile, and paths of more than one bounce on a bottom that is not level.
//
// Thread rule: free functions on values, which threads may call at the same time.
#pragma once

#include <vector>

#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/layered_rays.h"
#include "acoustics/rays/ray_trace.h"

namespace halocline::acoustics {

inline constexpr double kStraight = 0.125, kBent = 0.25;  // e of folds 4 and 2 sigma_z away
// Launch angles between the steepest rays that turn: more where a link is many depths long.
inline constexpr int kMinShadowRays = 16, kMaxShadowRays = 48;

// Smooths the paths of `link`, found in the same sea; RayOptions::fine_structure says how much. Paths stay
// sorted by delay.
void smooth_folds(const FlatSea& sea, const RayLink& link, std::vector<Eigenray>& paths);
void smooth_folds(const ProfiledSea& sea, const RayLink& link, std::vector<Eigenray>& paths);

}  // namespace halocline::acoustics
