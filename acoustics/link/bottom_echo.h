// SPDX-License-Identifier: BSD-3-Clause
// Assesses if an echo from the bottom may interfere with the direct path (the query GETML of the 2010 paper).
//
// Model (Sehgal, Cernea and Birk 2010): sound goes from the transmitter to points of the bottom along the
// line to the receiver, and on from there to the receiver. Each path has the loss of a straight link over its
// total length (leg by leg through alpha(z)) and that of the beams at both ends. It counts when its level
// exceeds the receiver's cut-off and the bottom stands above neither leg. The bottom reflects all energy in
// every direction: an upper bound. The bottom is known at kBottomDepths places between the ends, of which one
// in kReflectingOneIn reflects; narrower relief blocks nothing. Left out: loss and direction at the bounce,
// surface echoes, more than one bounce (see acoustics/rays).
#pragma once

#include <span>

#include "acoustics/link/link_kernel.h"
#include "core/frames.h"
#include "core/units.h"

namespace halocline::acoustics {

// The places of the bottom: nine reflect. With the four beside each, the verdict over the ridge of
// studies/paper/ridge.py is that of its full relief at 98 % of the receivers.
inline constexpr int kReflectingOneIn = 5, kBottomDepths = 9 * kReflectingOneIn;

// Level at the receiver, dB re 1 uPa, of the path by one point of the bottom; positions as in
// LinkKernel::budget.
Decibels echo_level(const LinkKernel& model, const Vec3& from_ned_m, const Vec3& to_ned_m,
                    const Vec3& bottom_ned_m);

// True when an echo is likely. `bottom_z_m` holds z of the bottom, m, at the middles of equal parts of the
// line between the ends; the third reflects, and from there on one in kReflectingOneIn. Places above the sea
// surface reflect nothing.
bool is_echo_likely(const LinkKernel& model, const Vec3& from_ned_m, const Vec3& to_ned_m,
                    std::span<const double> bottom_z_m);

}  // namespace halocline::acoustics
