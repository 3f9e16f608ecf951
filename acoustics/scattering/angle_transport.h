// SPDX-License-Identifier: BSD-3-Clause
// Transport of power over grazing angle in a sea of one depth.
//
// State. Power in bins of Snell's xi = cos(angle) / c; angles are those at the least sound speed, with edges
//   88 degrees (0.03 u + 0.97 u^2), u = 0..1
// because low angles need the fine bins. Rays that miss the surface or the bottom have at least a third of
// them, and the edges nearest to rays that just meet a boundary are moved to these: with 48 bins, power is
// within 0.5 dB of that of many, where without it is 3 dB off in water of little refraction. Where a barrier
// of faster water divides the rays of a bin, each duct has a state of its own. A state has a cycle D (range
// from one meeting of a boundary, or one turning depth, to the next of the same kind), the time, length and
// absorption of a cycle, and the sine of the grazing angle at each boundary that it meets.
//
// One bounce. Of the kept power B of a bounce the coherent share E = exp(-Gamma^2), Gamma = 2 k sigma sin,
// goes on at its angle; K_ij sqrt(B_i B_j) goes to state j (acoustics/scattering/facet_kernel.h).
//
// Between bounces dP/dr = M P: turning at the mean rate K_ij / D_i, and losses as nepers a metre, absorption
// times length / D and -ln(B) / D of each boundary. Fine structure turns rays by mu = d<theta^2>/dr, an
// exchange between neighbour bins of flow 0.5 mu (sin / c)^2 D / |delta xi|. M times the measure D dxi is
// symmetric, so its eigenvalues are real and negative, and P(r) is a sum of exponentials.
//
// Source: energy flux, Weston 1971 (J. Sound Vib. 18:271) and 1980 (JASA 68:282); mean rates and bins are our
// choices. Against rays scattered one by one: within 0.3 dB at 8 of 13 places, 1.2 dB at worst. Left out:
// shadowing by relief, sound scattered backwards.
//
// Immutable: calls may overlap between threads.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

// A boundary of the transport.
struct RoughBoundary {
  double rms_height_m = 0;    // sigma, >= 0
  double slope_variance = 0;  // s2 of its facets in the plane of the sound; 0: smooth, whatever its height
  std::function<double(double)> kept = {};  // B at a sine of the grazing angle in (0, 1]; empty: 1
  // Variance of the slopes of relief larger than a search's grid: it turns all power, the coherent share too.
  double relief_variance = 0;
};
// The sea's surface under that wind, waves of Pierson and Moskowitz, or under ice; a loss of at most 15 dB a
// bounce.
RoughBoundary scattering_surface(const RaySurface& surface, double frequency_hz);
// A bottom of that sediment under water of `speed_mps`, rms roughness and variance of slopes.
RoughBoundary rough_bottom(const FluidBottom& bottom, double speed_mps, double rms_height_m,
                           double slope_variance);

// The sea of a transport. The water has to outlive the construction only.
struct TransportSea {
  const RayWater& water;
  double depth_m = 0;       // above 0
  double frequency_hz = 0;  // above 0; the water's absorption is that at this frequency
  RoughBoundary surface, bottom;
  std::vector<double> speed_deviation_mps = {};  // of fine structure, of each layer of the water; empty: none
  std::size_t bins = 48;
};

// Power of one bin in one duct.
struct TransportState {
  std::size_t bin = 0;
  double xi_spm = 0, width_spm = 0;          // xi and dxi, s/m
  double upper_m = 0, lower_m = 0;           // depths between which its rays run
  double cycle_m = 0;                        // D
  double excess_spm = 0;                     // time / D less reference_spm(), s/m
  double nepers_per_m = 0;                   // absorption of power, alpha length / D
  double surface_sine = 0, bottom_sine = 0;  // 0 where it turns before
  double measure() const { return cycle_m * width_spm; }
};

// Which boundary.
enum class Boundary : std::size_t { kSurface = 0, kBottom = 1 };

class AngleTransport {
 public:
  // Throws InvalidArgument when a number of the sea is out of range.
  explicit AngleTransport(const TransportSea& sea);

  std::size_t size() const { return states_.size(); }
  const std::vector<TransportState>& states() const { return states_; }
  double depth_m() const { return depth_m_; }
  double least_speed_mps() const { return least_speed_; }
  // The least time / D of all states, to which delays refer, s/m.
  double reference_spm() const { return reference_; }
  // Layers of the water down to the bottom: depths and speeds of their edges.
  const std::vector<double>& depths_m() const { return depths_; }
  const std::vector<double>& speeds_mps() const { return speeds_; }
  double speed_at(double depth_m) const;
  // Edges of the bins, as angles at the least sound speed, and cos(edge) / c_min, falling.
  const std::vector<double>& edges_rad() const { return edges_; }
  double edge_xi(std::size_t edge) const { return edge_xi_[edge]; }

  // Row i of the matrix T of one bounce: what it makes of a unit of power of state i, losses included.
  const double* bounce_row(Boundary boundary, std::size_t i) const {
    return &bounce_[static_cast<std::size_t>(boundary)][i * size()];
  }
  // The state that rays of state i belong to when they meet the boundary: itself, or the next steeper one
  // that meets it; size() when none does.
  std::size_t meeting(Boundary boundary, std::size_t i) const;
  // The state of a bin at a depth.
  std::size_t state_at(std::size_t bin, double depth_m) const;

  // Eigenvalues of M, 1/m, from the slowest decay to the fastest; row k of vectors() is the eigenvector of
  // values()[k] in the coordinates P_i / sqrt(measure_i).
  const std::vector<double>& values() const { return values_; }
  double slowest() const { return values_.front(); }
  // Number of eigenvectors, from the slowest on, that keep more than 1e-16 of the slowest one's share over a
  // distance, m.
  std::size_t lasting(double distance_m) const;
  const std::vector<double>& vectors() const { return vectors_; }
  const std::vector<double>& root_measures() const { return roots_; }
  // T_kl = sum over i of vectors_ki excess_i vectors_li, s/m.
  const std::vector<double>& excess_matrix() const { return excess_matrix_; }
  // T_kl / (values_k - values_l), s; 0 where both are equal.
  const std::vector<double>& excess_quotients() const { return excess_quotients_; }

  // Action of the rays at each edge of the bins: the integral of sqrt(1/c^2 - xi^2) over depth, s, rising.
  const std::vector<double>& actions() const { return actions_; }

 private:
  struct Rates;
  void set_layers(const TransportSea& sea);
  void set_edges(std::size_t bins);
  void move_edge_to(double theta);
  void add_states(const TransportSea& sea, std::size_t bin);
  void add_boundary(const TransportSea& sea, Boundary which, Rates& rates);
  void add_fine_structure(const TransportSea& sea, Rates& rates) const;
  double turning_rate(const TransportSea& sea, const TransportState& state) const;
  void solve(Rates& rates);

  double depth_m_, least_speed_ = 0, reference_ = 0;
  std::vector<double> depths_, speeds_, edges_, edge_xi_, actions_;
  std::vector<TransportState> states_;
  std::vector<std::vector<std::size_t>> of_bin_;  // states of each bin, from the surface down
  std::array<std::vector<double>, 2> bounce_;
  std::vector<double> values_, vectors_, roots_, excess_matrix_, excess_quotients_;
};

}  // namespace halocline::acoustics
