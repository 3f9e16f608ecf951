// SPDX-License-Identifier: BSD-3-Clause
// One end of a link in a transport over angles: what it launches, where its rays bounce first, and what it
// receives.
//
// Launch. A source of 1 per steradian launches p_i = 2 (sin b - sin a) into state i, a and b the edges of its
// bin at the source, half up and half down. Eight rays of each bin and direction meet their first boundary
// where they are, at x. They are gathered in cells of x (edges H / 8 * 2^(n / 2), H the depth); cell m keeps
// the power S_mj that T brings into state j, and the mean x, excess time and angle of its rays.
//
// Reception. Power P_i has the intensity R_i P_i / r, R_i = 2 / (D_i sin theta_i), 1 / sin as its mean over
// the bin, (b - a) / (c dxi). The adjoint F_j(y) = R exp(M y) is what a unit of power in state j brings after
// a further y. It is tabulated over the distance d from a first bounce with y = d - D_j / 4, half of the way
// to the next bounce (below 0: no loss yet but absorption), at d = 0 and H / 8 * 2^(n / 2); between nodes ln
// F is linear. Beside it stand mean and variance of the delay beyond d times the transport's reference, from
//   dQ/dr = M Q + tau P,  dR/dr = M R + 2 tau Q.
//
// Accuracy: ln F within 0.01 between nodes once the loss is even, the moments within 3 %. Immutable: calls
// may overlap between threads.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "acoustics/scattering/angle_transport.h"

namespace halocline::acoustics {

// Moments of what arrives, by the state of the start: power F, its delay's first and second moment, and the
// distance that they are for. In the coordinates of the transport's eigenvectors, less the slowest decay.
struct CarriedMoments {
  std::vector<double> power, first, second;
};
// The moments of `from` over a further distance >= 0, m.
CarriedMoments carried(const AngleTransport& transport, const CarriedMoments& from, double distance_m);
// Moments by state and back.
CarriedMoments in_eigenvectors(const AngleTransport& transport, const CarriedMoments& by_state);
CarriedMoments by_state(const AngleTransport& transport, const CarriedMoments& in_eigenvectors);

// Table over nodes of distance, by state: ln F, and mean and variance of the excess delay.
struct ReceptionTable {
  static constexpr std::size_t kNodes = 32;
  // Distance of a node, m: 0, then unit_m 2^((n - 1) / 2).
  double distance_m(std::size_t node) const;
  // The node at or below a distance >= 0 (at most the last but one), and the share of the way to the next.
  struct Place {
    std::size_t node;
    double share;
  };
  Place place_of(double distance_m) const;

  double unit_m = 1;
  std::size_t size = 0;                                // states
  std::vector<double> log_power, mean_s, variance_s2;  // kNodes x size
};

// Rays that bounce first within one cell of distance.
struct FirstBounces {
  double begin_m = 0, end_m = 0;  // of the cell
  double distance_m = 0;          // mean x
  double excess_s = 0;            // mean time in excess of x times the reference
  double sine_squares = 0;        // mean sin^2 of the launch angle
  double power = 0;               // of all, before the bounce; 0: an empty cell
  std::vector<double> launched;   // before the bounce, by state, without absorption
  std::vector<double> bounced;    // S, after the bounce, by state, with absorption
};

class TransportEnd {
 public:
  static constexpr std::size_t kCells = 30;

  // `depth_m` 0..the transport's depth. An end that is `tabulated` has a table; others serve links over
  // several stretches of depth.
  TransportEnd(const AngleTransport& transport, double depth_m, bool tabulated = true);
  // The end between two of the same transport, by the power: `share` 0..1 of the second. Its table, where
  // both have one, holds the distances up to `reach_m` alone.
  static TransportEnd between(const TransportEnd& first, const TransportEnd& second, double share,
                              double reach_m);

  const std::vector<double>& reception() const { return reception_; }  // R, by state
  const ReceptionTable& table() const { return table_; }               // empty unless tabulated
  const std::vector<FirstBounces>& first_bounces() const { return cells_; }
  // Launched power by state of the rays that meet no boundary.
  const std::vector<double>& never_bouncing() const { return never_; }

 private:
  TransportEnd() = default;
  void launch(const AngleTransport& transport, double depth_m);
  void receive(const AngleTransport& transport, double depth_m);
  void tabulate(const AngleTransport& transport);

  std::vector<double> reception_, never_;
  std::vector<FirstBounces> cells_;
  ReceptionTable table_;
};

}  // namespace halocline::acoustics
