// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/layered_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "acoustics/math/fold_field.h"
#include "acoustics/math/hermite_cubic.h"
#include "acoustics/rays/arcs/layered_legs.h"
#include "acoustics/rays/layered_eigenray.h"
#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr double kMinAngle = 1e-9;        // rad at the barrier: first angle of a table
constexpr int kDeepestRefinement = 12;    // halvings of an interval between barriers
constexpr double kCubicTolerance = 0.15;  // in f: permitted error of its cubic at the middle of a cell
constexpr double kNearFold = 0.2;         // in f: a turn this near to a whole number is located exactly
constexpr double kDarkReach = 4;          // Airy lengths: twice the distance at which there are still paths
// Natural log of a factor: cells are skipped only when clearly below the least factor.
constexpr double kMarginOfFactor = 0.7;

// Margin on the change of f over a cell, beyond what its slopes allow.
constexpr double kClearOfRays = 0.02;
constexpr std::size_t kUsualPaths = 64;  // per link, for the first allocation

// f = (r - b) / X of the four families and its slope, at one angle of one interval between barriers.
struct Node {
  double theta = 0;
  LegSums sums;
  std::array<double, 4> f{}, slope{};
  double log_factor = 0;  // natural log of the pressure factor of one bottom bounce
};

// A bracket of one crossing: two angles at which f - n has opposite signs.
struct Bracket {
  double from, to;  // angles at the barrier, rad
  bool rising;
  double guess;
};

// A run of intervals between barriers over which ranges change smoothly.
struct Run {
  int number = 0;
  // True when the run begins with rays that are horizontal at that end of the link and turn back at once.
  bool at_upper = false, at_lower = false;
};

// The search for all rays of one link.
class Search {
 public:
  Search(const FlatSea& sea, const RayLink& link)
      : link_(sea, link),
        legs_(sea.water, link_.upper_m, link_.lower_m, sea.bottom_depth_m,
              sea.options.airy_folds ? sea.options.frequency_hz : 0) {}

  std::vector<Eigenray> run() {
    paths_.reserve(kUsualPaths);
    add_horizontal();
    do {
      scan_interval();
    } while (!past_steepest_ && legs_.advance());
    finish(paths_, members_, link_.sea.options);
    return std::move(paths_);
  }

 private:
  // Adds the straight horizontal ray between ends at one depth within a layer of constant speed, which no
  // angle > 0 reaches.
  void add_horizontal();
  void scan_interval();
  void start_run();
  // The angle at the barrier of the ray that becomes horizontal at the sound speed `c`, which is at least the
  // barrier's:
  //   tan^2 = (c^2 - c*^2) / c*^2
  double theta_reaching(double c) const;
  Node node_at(double theta) const;
  void refine(const Node& a, const Node& b, int depth);
  bool is_clear(const Node& a, const Node& b) const;
  void solve_cell(const Node& a, const Node& b);
  void solve_family(const Node& a, const Node& b, std::size_t family);
  // Solves for the rays between two nodes between which f is monotone.
  int most_cycles(const Node& a, const Node& b) const;
  void solve_monotone(const Node& a, const Node& b, std::size_t family);
  void polish(const Bracket& bracket, std::size_t family, int cycles);
  // True when no ray of the family between two nodes can exceed the least boundary factor, at `min_f` cycles
  // or more.
  bool too_faint(const Node& a, const Node& b, std::size_t family, double min_f) const;
  void seek_turn(const Node& a, const Node& b, std::size_t family, Node& turn) const;
  // Adds the path on the shadow side of the fold at `turn`, when the link lies there.
  void add_dark_path(const Node& a, const Node& b, const Node& turn, bool is_greatest, std::size_t family);
  // Estimate of how far sound reaches beyond a turn of f between two nodes, in units of f.
  double dark_reach(const Node& a, const Node& b, std::size_t family) const;
  FoldMember member_of(const Eigenray& path, std::size_t family, int cycles, const Passed& passed) const;

  LayeredLink link_;
  LayeredLegs legs_;
  std::vector<Eigenray> paths_;
  std::vector<FoldMember> members_;  // one for each path
  Run run_;
  bool direct_only_ = false, past_steepest_ = false;
};

// f over the angle between two nodes.
HermiteCubic cubic_of(const Node& a, const Node& b, std::size_t family) {
  return {a.f[family], a.slope[family], b.f[family], b.slope[family], b.theta - a.theta};
}

void Search::add_horizontal() {
  if (link_.upper_m != link_.lower_m) return;
  const RayWater& water = link_.sea.water;
  const double z = link_.upper_m;
  const std::size_t layer = water.layer_at(z);
  const bool still = water.gradients_per_s()[layer] == 0 ||
                     (layer > 0 && z == water.depths_m()[layer] && water.gradients_per_s()[layer - 1] == 0);
  if (!still) return;
  Eigenray path;
  path.delay_s = link_.range_m / link_.source_speed_mps;
  path.amplitude = 1 / link_.range_m;
  path.launch_slowness_spm = path.range_slowness_spm = 1 / link_.source_speed_mps;
  path.path_length_m = link_.range_m;
  path.absorption_db = link_.range_m * water.absorption_db_per_m(z);
  paths_.push_back(path);
  members_.emplace_back();
}

double Search::theta_reaching(double c) const {
  const double barrier = legs_.barrier_mps();
  return elementary::atan2(std::sqrt(std::max(0.0, (c - barrier) * (c + barrier))), barrier);
}

void Search::scan_interval() {
  // A ray launched at the greatest permitted angle becomes horizontal at the speed c_source / cos(angle).
  const double cosine = elementary::cos(link_.sea.options.max_launch_angle_rad);
  const double next = legs_.next_barrier_mps();
  const double steepest = cosine > 1e-12
                              ? theta_reaching(std::max(link_.source_speed_mps / cosine, legs_.barrier_mps()))
                              : pi / 2;
  if (run_.number == 0 || !legs_.is_smooth() || !link_.sea.options.airy_folds) start_run();
  double to = next > 0 ? theta_reaching(next) : pi / 2;
  past_steepest_ = next <= 0;
  const double limit = direct_only_ ? kMinAngle : std::min(to, steepest);
  const double core = link_.sea.core_speed_mps;
  const double from = core > legs_.barrier_mps() ? theta_reaching(core) : kMinAngle;
  if (limit > from) refine(node_at(from), node_at(limit), 0);
  if (limit >= to) return;
  direct_only_ = true;
  refine(node_at(std::max(limit, kMinAngle)), node_at(to), 0);
}

Node Search::node_at(double theta) const {
  Node node;
  node.theta = theta;
  const double sine = elementary::sin(theta), cosine = elementary::cos(theta), r = link_.range_m;
  node.sums = legs_.sums(sine, cosine);
  for (std::size_t k = 0; k < kEigenrayFamilies.size(); ++k) {
    const RangeTerms t = range_terms(node.sums, kEigenrayFamilies[k]);
    // The equation for f and its derivative, with dxi/dtheta = -sin / c*:
    //   f = (r / xi - b_q) / X_q,  df/dtheta = (b_m + f X_m) tan(theta) / X_q
    // As the ray becomes vertical (xi -> 0), f grows without bound.
    node.f[k] = (r - node.sums.xi * t.bq) / (node.sums.xi * t.xq);
    node.slope[k] = (t.bm + node.f[k] * t.xm) * sine / (cosine * t.xq);
  }
  node.log_factor = legs_.meets_bottom() ? elementary::log(link_.bottom_factor(node.sums)) : 0;
  return node;
}

bool Search::too_faint(const Node& a, const Node& b, std::size_t family, double min_f) const {
  if (direct_only_) return family != 0;
  const int below =
      std::max(0, static_cast<int>(std::ceil(min_f))) + (kEigenrayFamilies[family].down ? 1 : 0);
  const double log_factor = std::max(a.log_factor, b.log_factor);
  return below * log_factor < link_.log_min_factor - kMarginOfFactor;
}

void Search::refine(const Node& a, const Node& b, int depth) {
  if (is_clear(a, b)) return;
  bool any = false, fits = true;
  const Node middle = node_at(0.5 * (a.theta + b.theta));
  for (std::size_t k = 0; k < kEigenrayFamilies.size(); ++k) {
    const double least = std::min({a.f[k], b.f[k], middle.f[k]});
    if (too_faint(a, b, k, least - 0.5)) continue;
    any = true;
    const double error = cubic_of(a, b, k).error_at_middle(middle.f[k], middle.slope[k], b.theta - a.theta);
    // A large f means many rays, which the cubic only has to keep apart.
    fits = fits && error <= kCubicTolerance * (1 + 0.05 * std::abs(middle.f[k]));
  }
  if (!any) return;
  if (fits || depth >= kDeepestRefinement) {
    solve_cell(a, middle);
    solve_cell(middle, b);
  } else {
    refine(a, middle, depth + 1);
    refine(middle, b, depth + 1);
  }
}

// True when clearly no ray of any family lies between two nodes: the slopes cannot bring f to a whole number
// within the cell.
bool Search::is_clear(const Node& a, const Node& b) const {
  for (std::size_t k = 0; k < kEigenrayFamilies.size(); ++k) {
    const double change = std::max(std::abs(a.slope[k]), std::abs(b.slope[k])) * (b.theta - a.theta) +
                          std::max(dark_reach(a, b, k), kClearOfRays);
    const double least = std::min(a.f[k], b.f[k]) - change, most = std::max(a.f[k], b.f[k]) + change;
    if (most < 0 || too_faint(a, b, k, least)) continue;
    if (std::ceil(least) <= most) return false;
  }
  return true;
}

void Search::solve_cell(const Node& a, const Node& b) {
  for (std::size_t k = 0; k < kEigenrayFamilies.size(); ++k) {
    if (!too_faint(a, b, k, std::min(a.f[k], b.f[k]) - 0.5)) solve_family(a, b, k);
  }
}

void Search::solve_family(const Node& a, const Node& b, std::size_t family) {
  const HermiteCubic cubic = cubic_of(a, b, family);
  Node from = a;
  for (const double t : cubic.turns()) {
    const double expected = cubic(t);
    Node turn = node_at(a.theta + t * (b.theta - a.theta));
    if (turn.theta <= from.theta) continue;
    if (std::abs(expected - std::round(expected)) < kNearFold) {
      const bool is_greatest = from.f[family] < expected;
      seek_turn(from, b, family, turn);
      const double off = is_greatest ? std::ceil(turn.f[family]) - turn.f[family]
                                     : turn.f[family] - std::floor(turn.f[family]);
      if (off < dark_reach(a, b, family)) add_dark_path(a, b, turn, is_greatest, family);
    }
    solve_monotone(from, turn, family);
    from = turn;
  }
  solve_monotone(from, b, family);
}

// Moves `turn`, a guess between two nodes, to where the slope of f is 0, by the secant method bounded by
// bisection. Leaves `turn` unchanged when there is no such place.
void Search::seek_turn(const Node& a, const Node& b, std::size_t family, Node& turn) const {
  const auto rises = [family](const Node& node) { return node.slope[family] > 0; };
  const bool before = rises(a) != rises(turn);
  if (!before && rises(turn) == rises(b)) return;
  Node low = before ? a : turn, high = before ? turn : b;
  for (int i = 0; i < 40; ++i) {
    const double share = low.slope[family] / (low.slope[family] - high.slope[family]);
    const double bounded = i % 3 == 2 ? 0.5 : std::clamp(share, 0.01, 0.99);
    turn = node_at(low.theta + bounded * (high.theta - low.theta));
    if (std::abs(turn.slope[family]) * (high.theta - low.theta) < 1e-12) break;
    (rises(turn) == rises(low) ? low : high) = turn;
  }
}

double Search::dark_reach(const Node& a, const Node& b, std::size_t family) const {
  if (!(a.slope[family] * b.slope[family] < 0) || !link_.sea.options.airy_folds || direct_only_) return 0;
  // d range/d xi is about df/dtheta (cos / sin) X / xi. At the edge of a family it does not measure the
  // curvature.
  const auto range_slope = [family](const Node& node) {
    const double tangent = elementary::tan(node.theta);
    return std::abs(node.slope[family]) * range_terms(node.sums, kEigenrayFamilies[family]).xq / tangent;
  };
  const double bend = (range_slope(a) + range_slope(b)) / std::abs(b.sums.xi - a.sums.xi);
  const double cycle_m = a.sums.xi * range_terms(a.sums, kEigenrayFamilies[family]).xq;
  return std::min(kDarkReach * Fold{bend, 1}.length_m(link_.sea.options.frequency_hz) / cycle_m, kNearFold);
}

// f turns at `turn`, at a number of cycles that is not whole. The fold of the rays with the nearest whole
// number of cycles beyond it lies close by.
void Search::add_dark_path(const Node& a, const Node& b, const Node& turn, bool is_greatest,
                           std::size_t family) {
  const double f = turn.f[family];
  const int cycles = static_cast<int>(is_greatest ? std::ceil(f) : std::floor(f));
  if (cycles < 0 || cycles > link_.sea.options.max_bounces) return;
  LayeredRay ray{kEigenrayFamilies[family], cycles, 0, 1};
  LegSums sums;
  if (!find_dark_ray(link_, legs_, {a.theta, b.theta, turn.theta, a.sums, b.sums}, ray, sums)) return;
  append_eigenray(link_, legs_, ray, sums, paths_);
  members_.resize(paths_.size());
}

// Rays of more cycles have no coherent share or too many bounces.
int Search::most_cycles(const Node& a, const Node& b) const {
  if (direct_only_) return 0;
  const RayOptions& options = link_.sea.options;
  const double top = std::min(a.sums.sine_top, b.sums.sine_top);
  const double base = std::min(a.sums.sine_bottom, b.sums.sine_bottom);
  const double of_cycle = options.scattering.nepers(top * top, base * base);
  if (!(of_cycle > 0)) return options.max_bounces;
  const double cycles = std::floor(BounceScattering::kMaxNepers / of_cycle) + 2;
  return static_cast<int>(std::min<double>(cycles, options.max_bounces));
}

void Search::solve_monotone(const Node& a, const Node& b, std::size_t family) {
  const double low = std::min(a.f[family], b.f[family]), high = std::max(a.f[family], b.f[family]);
  if (!(high >= 0)) return;
  const int most = most_cycles(a, b);
  const int first = static_cast<int>(std::ceil(std::max(low, 0.0)));
  const int last =
      static_cast<int>(std::min(std::ceil(high) - 1, static_cast<double>(most)));  // low <= n < high
  if (last < first) return;
  const HermiteCubic cubic = cubic_of(a, b, family);
  for (int n = first; n <= last; ++n) {
    const double t = cubic.crossing(n);
    polish({a.theta, b.theta, b.f[family] > a.f[family], a.theta + t * (b.theta - a.theta)}, family, n);
  }
}

void Search::polish(const Bracket& bracket, std::size_t family, int cycles) {
  double low = bracket.from, high = bracket.to, theta = bracket.guess, off_before = kNotYet;
  LayeredRay ray{kEigenrayFamilies[family], cycles, 0, 1};
  LegSums sums;
  RangeTerms t{};
  for (int i = 0; i < 60; ++i) {
    ray.sine = elementary::sin(theta);
    ray.cosine = elementary::cos(theta);
    sums = legs_.sums(ray.sine, ray.cosine);
    t = range_terms(sums, ray.family);
    // Newton's method on f: f - n = (r - b - n X) / X, with all ranges divided by xi.
    const double off = link_.range_m - sums.xi * (t.bq + cycles * t.xq);  // (f - n) X, m
    if (is_settled(off, off_before)) break;
    off_before = off;
    const double f = cycles + off / (sums.xi * t.xq);
    const double slope = (t.bm + f * t.xm) * ray.sine / (ray.cosine * t.xq);
    ((off > 0) == bracket.rising ? high : low) = theta;
    const double next = slope != 0 ? theta - (f - cycles) / slope : -1;
    theta = next > low && next < high ? next : 0.5 * (low + high);
    if (high - low < 1e-15 * high) break;
  }
  const Passed passed = append_eigenray(link_, legs_, ray, sums, paths_);
  if (members_.size() == paths_.size()) return;  // excluded by the options
  members_.push_back(member_of(paths_.back(), family, cycles, passed));
}

// Two rays that leave an end nearly horizontally, one upwards and one downwards, are neighbours when the
// water turns the one back at once. Such a run counts both as one family.
void Search::start_run() {
  const double barrier = legs_.barrier_mps();
  const double upper_mps = link_.source_is_upper ? link_.source_speed_mps : link_.receiver_speed_mps;
  const double lower_mps = link_.source_is_upper ? link_.receiver_speed_mps : link_.source_speed_mps;
  ++run_.number;
  run_.at_upper = upper_mps == barrier && lower_mps < barrier && legs_.turns_at_once(Leg::kUp);
  run_.at_lower = lower_mps == barrier && upper_mps < barrier && legs_.turns_at_once(Leg::kDown);
}

FoldMember Search::member_of(const Eigenray& path, std::size_t family, int cycles,
                             const Passed& passed) const {
  std::uint64_t legs = family;
  if (run_.at_upper) legs = 4 + (family & 2);
  if (run_.at_lower) legs = 8 + (family & 1);
  const bool by_launch = run_.at_upper   ? link_.source_is_upper
                         : run_.at_lower ? !link_.source_is_upper
                                         : true;
  const std::uint64_t of_cycles =
      continued_family(continued_family(0, legs), static_cast<std::uint64_t>(cycles));
  return {continued_family(of_cycles, static_cast<std::uint64_t>(run_.number)),
          by_launch ? path.launch_angle_rad : path.arrival_angle_rad, passed.touched, passed.phase_rad};
}

}  // namespace

std::vector<Eigenray> layered_rays(const FlatSea& sea, const RayLink& link) {
  validate(sea.options);
  return Search(sea, link).run();
}

}  // namespace halocline::acoustics
