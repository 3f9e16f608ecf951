// SPDX-License-Identifier: BSD-3-Clause
// Turned sound: the power that reaches a receiver after its first bounce, at new angles, and its delays.
//
// Model, over one depth (acoustics/scattering/transport_end.h): with the first bounces of the source at x,
//   A(r) = (1 / r) sum over cells m and states j of S_mj F_j(r - x_m).
// Rays that have not bounced (x > r) are the traced ones, never the transport's. Over a depth that varies,
// stretches of constant depth follow each other; between them rays keep their action, the integral of
// sqrt(1/c^2 - xi^2) over depth, so that what becomes steeper loses more at the bottom. The first bounce is
// that of the first stretch.
//
// A from either end differs by up to 0.8 dB: a link takes the mean of the two directions.
#pragma once

#include <memory>
#include <vector>

#include "acoustics/scattering/angle_transport.h"
#include "acoustics/scattering/transport_end.h"

namespace halocline::acoustics {

// Sound that arrives by way of one state after the first bounce.
struct TurnedPart {
  double power = 0;         // re 1 m
  double excess_s = 0;      // mean delay in excess of TurnedSound::reference_s
  double variance_s2 = 0;   // of the delay
  double sine_squares = 0;  // mean sin^2 of the launch angle
};

// Sound of one direction of a link.
struct TurnedSound {
  double power = 0;               // A, re 1 m, absorption included
  double unbounced = 0;           // power of the rays that have not bounced, likewise
  double reference_s = 0;         // delay of the earliest sound, to which the others refer
  std::vector<TurnedPart> parts;  // by state
};

// The turned sound of a link of `range_m` > 0 in water of one depth.
TurnedSound turned_sound(const AngleTransport& transport, const TransportEnd& source,
                         const TransportEnd& receiver, double range_m);

// Part of a link over which the depth is constant.
struct Stretch {
  std::shared_ptr<const AngleTransport> transport;
  double length_m = 0;  // above 0
};
// The turned sound over two stretches or more, from the source's on, all of the same number of bins.
TurnedSound turned_sound(const std::vector<Stretch>& stretches, const TransportEnd& source,
                         const TransportEnd& receiver);

}  // namespace halocline::acoustics
