// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/eigenray.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>

#include "acoustics/math/fold_field.h"
#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

// Limits below which, in both delay and angle, two paths of one kind are the two sides of a fold that no
// receiver can resolve.
constexpr double kMergedDelay = 1e-6;  // s
const double kMergedAngle = to_radians(0.02);

constexpr int kCountBits = 14, kBranchBits = 7;  // of a packed identity

constexpr std::uint64_t low_bits(std::uint64_t number, int bits) {
  return number & ((std::uint64_t{1} << bits) - 1);
}

// Sort key: paths are large and are moved only once.
struct Key {
  std::uint64_t kind;
  double launch_rad, delay_s;
  std::size_t index;
};

// An identity without its branch, packed into one number; counts are below 16 384.
std::uint64_t kind(const Eigenray& path) {
  const PathIdentity& id = path.identity;
  std::uint64_t packed = id.launched_up ? 1 : 0;
  for (const int count : {id.surface_bounces, id.bottom_bounces, id.upper_turns, id.lower_turns}) {
    packed = (packed << 14) | static_cast<std::uint64_t>(std::min(count, 16'383));
  }
  return packed;
}

bool are_one_fold(const Key& a, const Key& b) {
  return a.kind == b.kind && std::abs(a.delay_s - b.delay_s) < kMergedDelay &&
         std::abs(a.launch_rad - b.launch_rad) < kMergedAngle;
}

// The stronger of two paths with the pressure of both, the sum at the carrier f:
//   A e^(i (phi - 2 pi f t))
Eigenray merged(const Eigenray& a, const Eigenray& b, double frequency_hz) {
  const auto phasor = [frequency_hz](const Eigenray& path) {
    return elementary::polar(path.amplitude,
                             path.phase_rad - 2 * pi * std::fmod(frequency_hz * path.delay_s, 1.0));
  };
  Eigenray both = a.amplitude >= b.amplitude ? a : b;
  const std::complex<double> sum = phasor(a) + phasor(b);
  const double turned = elementary::arg(sum) + 2 * pi * std::fmod(frequency_hz * both.delay_s, 1.0);
  both.amplitude = elementary::abs(sum);
  both.phase_rad = positive_angle(turned);
  return both;
}

// Keys of the paths that are kept, sorted by kind and launch angle; the paths of an unresolved fold are
// merged.
std::vector<Key> keys_by_kind(std::vector<Eigenray>& paths, const RayOptions& options) {
  std::vector<Key> keys, kept;
  keys.reserve(paths.size());
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (paths[i].amplitude < options.min_amplitude || paths[i].amplitude <= 0) continue;
    keys.push_back({kind(paths[i]), paths[i].launch_angle_rad, paths[i].delay_s, i});
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return a.kind != b.kind ? a.kind < b.kind : a.launch_rad < b.launch_rad;
  });
  kept.reserve(keys.size());
  for (const Key& key : keys) {
    if (!kept.empty() && are_one_fold(kept.back(), key)) {
      Eigenray& one = paths[kept.back().index];
      one = merged(one, paths[key.index], options.frequency_hz);
    } else {
      kept.push_back(key);
    }
  }
  return kept;
}

void number_branches(const std::vector<Key>& keys, std::vector<Eigenray>& paths) {
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const bool same = i > 0 && keys[i - 1].kind == keys[i].kind;
    paths[keys[i].index].identity.branch = same ? paths[keys[i - 1].index].identity.branch + 1 : 0;
  }
}

// Two neighbouring rays of a fan that form a fold, by their indices among the paths, and their x.
struct FoldPair {
  std::size_t less, more;  // the ray that has touched fewer caustics, and the other
  double x;
};

std::vector<FoldPair> fold_pairs(const std::vector<Eigenray>& paths, const std::vector<FoldMember>& members,
                                 double frequency_hz) {
  ensure(members.size() == paths.size(), "a family for each path");
  std::vector<std::size_t> order(paths.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return members[a].family != members[b].family ? members[a].family < members[b].family
                                                  : members[a].order_rad < members[b].order_rad;
  });
  std::vector<FoldPair> pairs;
  for (std::size_t i = 1; i < order.size(); ++i) {
    const std::size_t one = order[i - 1], other = order[i];
    if (members[one].family != members[other].family || members[one].family == kNoFamily) continue;
    const int more = members[other].touched - members[one].touched;
    if (std::abs(more) != 1) continue;
    const double apart_s =
        std::abs(paths[other].delay_s - paths[one].delay_s -
                 (members[other].phase_rad - members[one].phase_rad) / (2 * pi * frequency_hz));
    const double x = members[one].x > 0 ? members[one].x : fold_place(apart_s, frequency_hz);
    if (x < kLitFold) pairs.push_back({more > 0 ? one : other, more > 0 ? other : one, x});
  }
  std::sort(pairs.begin(), pairs.end(), [](const FoldPair& a, const FoldPair& b) { return a.x < b.x; });
  return pairs;
}

// Applies to each ray the field of the fold nearest to it.
void apply_folds(std::vector<Eigenray>& paths, const std::vector<FoldMember>& members, double frequency_hz) {
  std::vector<bool> done(paths.size(), false);
  for (const FoldPair& pair : fold_pairs(paths, members, frequency_hz)) {
    const FoldShare share = fold_share(pair.x);
    Eigenray &less = paths[pair.less], &more = paths[pair.more];
    const bool merges = pair.x < kMergedFold && !done[pair.less] && !done[pair.more];
    const auto apply = [&](std::size_t index, double sign) {
      if (done[index]) return;
      done[index] = true;
      paths[index].amplitude *= share.factor;
      paths[index].phase_rad = positive_angle(paths[index].phase_rad + sign * share.phase_rad);
    };
    apply(pair.less, 1);
    apply(pair.more, -1);
    if (!merges) continue;
    const Eigenray both = merged(less, more, frequency_hz);
    (less.amplitude >= more.amplitude ? more : less).amplitude = 0;
    (less.amplitude > 0 ? less : more) = both;
  }
}

double most_loss_db(const RayOptions& options) {
  return -20 * elementary::log10(options.min_boundary_factor);
}

}  // namespace

std::uint64_t PathIdentity::number() const {
  std::uint64_t number = launched_up ? 1 : 0;
  for (const int count : {surface_bounces, bottom_bounces, upper_turns, lower_turns}) {
    number = number << kCountBits | low_bits(static_cast<std::uint64_t>(count), kCountBits);
  }
  return number << kBranchBits | low_bits(static_cast<std::uint64_t>(branch), kBranchBits);
}

PathIdentity PathIdentity::of_number(std::uint64_t number) {
  PathIdentity identity;
  identity.branch = static_cast<int>(low_bits(number, kBranchBits));
  number >>= kBranchBits;
  for (int* count :
       {&identity.lower_turns, &identity.upper_turns, &identity.bottom_bounces, &identity.surface_bounces}) {
    *count = static_cast<int>(low_bits(number, kCountBits));
    number >>= kCountBits;
  }
  identity.launched_up = number != 0;
  return identity;
}

double Eigenray::received_pressure() const { return amplitude * elementary::exp10(-absorption_db / 20); }

double Eigenrays::diffuse_power() const {
  double power = 0;
  for (const Eigenray& path : paths) {
    if (path.diffuse) power += path.received_pressure() * path.received_pressure();
  }
  return power;
}

std::string_view to_name(RaySolver solver) {
  switch (solver) {
    case RaySolver::kImages:
      return "images";
    case RaySolver::kSnell:
      return "snell";
    case RaySolver::kArcs:
      return "arcs";
  }
  return "";
}

std::string_view to_name(PathLack lack) {
  switch (lack) {
    case PathLack::kShadow:
      return "shadow";
    case PathLack::kTooWeak:
      return "too weak";
    case PathLack::kTooSteep:
      return "too steep";
  }
  return "";
}

RayLink held_apart(RayLink link) {
  const double down = link.receiver_depth_m - link.source_depth_m;
  const double least = std::sqrt(std::max(kMinDistance * kMinDistance - down * down, 0.0));
  link.range_m = std::max(link.range_m, least);
  return link;
}

void validate(const RayOptions& options) {
  require_in_range(options.frequency_hz, 10, 1e6, "ray frequency", "Hz");
  require_in_range(options.max_launch_angle_rad, 1e-6, pi / 2, "greatest launch angle", "rad");
  require_in_range(options.max_bounces, 0, 10'000, "greatest number of bounces");
  require_in_range(options.min_boundary_factor, 0, 0.999, "least factor of all bounces");
  require_in_range(options.min_amplitude, 0, 1e6, "least amplitude");
  if (options.diffuse_below_db != 0)
    require_in_range(options.diffuse_below_db, 10, 100, "level of diffuse sound below the strongest path",
                     "dB");
  if (options.diffuse_below_flux_db != 0)
    require_in_range(options.diffuse_below_flux_db, 10, 100, "level of diffuse sound below the energy flux",
                     "dB");
  require_in_range(options.diffuse_below_pressure, 0, 1e6, "pressure below which sound is diffuse");
  require_in_range(options.scattering.surface, 0, 1e12, "nepers that the surface scatters");
  require_in_range(options.scattering.bottom, 0, 1e12, "nepers that the bottom scatters");
  validate(options.fine_structure);
  require_in_range(options.platform_jitter_m, 0, 5, "vertical movement of the ends", "m");
}

RayOptions widened(RayOptions options) {
  constexpr double kStepDb = 10;
  if (!(options.min_boundary_factor > 0)) return options;
  const double steps = std::ceil(most_loss_db(options) / kStepDb);
  options.min_boundary_factor = elementary::exp10(-steps * kStepDb / 20);
  return options;
}

void drop_faint(std::vector<Eigenray>& paths, const RayOptions& options) {
  if (!(options.min_boundary_factor > 0)) return;
  std::erase_if(paths, [most_db = most_loss_db(options)](const Eigenray& path) {
    return path.bounce_loss_db() > most_db;
  });
}

void finish(std::vector<Eigenray>& paths, const std::vector<FoldMember>& members, const RayOptions& options) {
  if (options.airy_folds) apply_folds(paths, members, options.frequency_hz);
  std::vector<Key> keys = keys_by_kind(paths, options);
  number_branches(keys, paths);
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return a.delay_s != b.delay_s ? a.delay_s < b.delay_s : a.launch_rad < b.launch_rad;
  });
  std::vector<Eigenray> sorted;
  sorted.reserve(keys.size());
  for (const Key& key : keys) sorted.push_back(paths[key.index]);
  paths = std::move(sorted);
}

}  // namespace halocline::acoustics
