#include "acoustics/rays/arrivals.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>

#include "core/check.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

// Nearer in both, two paths of one kind are the two sides of a fold that no receiver can resolve.
constexpr double kMergedDelay = 1e-6;  // s
const double kMergedAngle = to_radians(0.02);

constexpr double kPeakPhase = 2.0 / 3 * 0.555 * 0.555 * 0.555 / 4;  // omega dt of Airy's greatest value
constexpr double kLeastTime = 1e-13;                                // s: rounding of a delay

// What sorting looks at: paths themselves are large and are moved once.
struct Key {
  std::uint64_t kind;
  double launch_rad, delay_s;
  std::size_t index;
};

// All of an identity but its branch; counts are below 16 384.
std::uint64_t kind(const Arrival& path) {
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

// The stronger of the two, with the pressure of both: the sum of A e^(i (phi - 2 pi f t)) at the carrier f.
Arrival merged(const Arrival& a, const Arrival& b, double frequency_hz) {
  const auto phasor = [frequency_hz](const Arrival& path) {
    return std::polar(path.amplitude, path.phase_rad - 2 * pi * std::fmod(frequency_hz * path.delay_s, 1.0));
  };
  Arrival both = a.amplitude >= b.amplitude ? a : b;
  const std::complex<double> sum = phasor(a) + phasor(b);
  const double turned = std::arg(sum) + 2 * pi * std::fmod(frequency_hz * both.delay_s, 1.0);
  both.amplitude = std::abs(sum);
  both.phase_rad = turned - 2 * pi * std::floor(turned / (2 * pi));
  return both;
}

// Keys of the paths that are kept, by kind and launch angle; paths of a fold become one.
std::vector<Key> keys_by_kind(std::vector<Arrival>& paths, const RayOptions& options) {
  std::vector<Key> keys, kept;
  keys.reserve(paths.size());
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (paths[i].amplitude < options.min_amplitude) continue;
    keys.push_back({kind(paths[i]), paths[i].launch_angle_rad, paths[i].delay_s, i});
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return a.kind != b.kind ? a.kind < b.kind : a.launch_rad < b.launch_rad;
  });
  kept.reserve(keys.size());
  for (const Key& key : keys) {
    if (!kept.empty() && are_one_fold(kept.back(), key)) {
      Arrival& one = paths[kept.back().index];
      one = merged(one, paths[key.index], options.frequency_hz);
    } else {
      kept.push_back(key);
    }
  }
  return kept;
}

void number_branches(const std::vector<Key>& keys, std::vector<Arrival>& paths) {
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const bool same = i > 0 && keys[i - 1].kind == keys[i].kind;
    paths[keys[i].index].identity.branch = same ? paths[keys[i - 1].index].identity.branch + 1 : 0;
  }
}

// What a fold leaves of the amplitude of its rays, `time_s` apart.
double fold_factor(double time_s, double frequency_hz) {
  const double phase = 2 * std::numbers::pi * frequency_hz * std::max(time_s, kLeastTime);
  return phase < kPeakPhase ? std::pow(phase / kPeakPhase, 1.0 / 6) : 1;
}

void bound_folds(std::vector<Arrival>& paths, const std::vector<std::uint64_t>& families,
                 double frequency_hz) {
  ensure(families.size() == paths.size(), "a family for each path");
  std::vector<std::size_t> order(paths.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return families[a] != families[b] ? families[a] < families[b]
                                      : paths[a].launch_angle_rad < paths[b].launch_angle_rad;
  });
  double before = 1;  // of the fold with the ray before
  for (std::size_t i = 0; i < order.size(); ++i) {
    Arrival& path = paths[order[i]];
    double after = 1;
    if (i + 1 < order.size() && families[order[i + 1]] == families[order[i]]) {
      const Arrival& next = paths[order[i + 1]];
      if (std::abs(next.caustics - path.caustics) == 1)
        after = fold_factor(std::abs(next.delay_s - path.delay_s), frequency_hz);
    }
    path.amplitude *= std::min(before, after);
    before = after;
  }
}

}  // namespace

double Arrival::received_pressure() const { return amplitude * std::pow(10.0, -absorption_db / 20); }

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
}

void finish(std::vector<Arrival>& paths, const std::vector<std::uint64_t>& families,
            const RayOptions& options) {
  bound_folds(paths, families, options.frequency_hz);
  std::vector<Key> keys = keys_by_kind(paths, options);
  number_branches(keys, paths);
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return a.delay_s != b.delay_s ? a.delay_s < b.delay_s : a.launch_rad < b.launch_rad;
  });
  std::vector<Arrival> sorted;
  sorted.reserve(keys.size());
  for (const Key& key : keys) sorted.push_back(paths[key.index]);
  paths = std::move(sorted);
}

}  // namespace halocline::acoustics
