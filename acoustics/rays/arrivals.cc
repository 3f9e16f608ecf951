#include "acoustics/rays/arrivals.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <numeric>

#include "core/check.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

// Nearer in both, two paths of one kind are the two sides of a fold that no receiver can tell apart.
constexpr double kMergedDelay = 1e-6;  // s
const double kMergedAngle = to_radians(0.02);

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

// The louder of the two, with the pressure of both.
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

// Whether two paths that were lost are the two sides of one fold, which end together as the receiver leaves
// them.
bool were_one_fold(const Arrival& a, const Arrival& b) {
  constexpr double kFoldWidth = 0.02;  // rad
  return a.surface_bounces == b.surface_bounces && a.bottom_bounces == b.bottom_bounces &&
         std::abs(a.caustics - b.caustics) == 1 &&
         std::abs(a.launch_angle_rad - b.launch_angle_rad) < kFoldWidth;
}

// Moves those of the lost that ended otherwise to the front and counts them.
std::size_t unexplained(std::vector<Arrival>& lost) {
  const std::vector<Arrival> all = lost;
  const auto folded = std::partition(lost.begin(), lost.end(), [&all](const Arrival& path) {
    return std::none_of(all.begin(), all.end(),
                        [&path](const Arrival& other) { return were_one_fold(path, other); });
  });
  return static_cast<std::size_t>(folded - lost.begin());
}

double power_of(const std::vector<Arrival>& paths) {
  return std::accumulate(paths.begin(), paths.end(), 0.0, [](double power, const Arrival& path) {
    return power + path.amplitude * path.amplitude;
  });
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

bool Arrivals::has_direct_path() const {
  return std::any_of(paths.begin(), paths.end(), [](const Arrival& path) {
    return path.surface_bounces == 0 && path.bottom_bounces == 0;
  });
}

FollowedRays follow_each(const std::vector<Arrival>& before, const RayOptions& options,
                         const FollowOne& follow_one, const LookAround& look_around) {
  constexpr double kMaxLostPower = 0.01;    // of all
  constexpr std::size_t kMaxLookedFor = 6;  // more, and a search of all is as quick
  FollowedRays now;
  now.paths.reserve(before.size());
  std::vector<Arrival> lost;
  for (const Arrival& path : before) {
    if (!follow_one(path, now.paths)) lost.push_back(path);
  }
  lost.resize(unexplained(lost));
  now.complete = lost.empty() || power_of(lost) <= kMaxLostPower * power_of(before);
  if (!now.complete && look_around && lost.size() <= kMaxLookedFor) {
    for (const Arrival& path : lost) look_around(path, now.paths);
    now.complete = true;
  }
  finish(now.paths, options);
  return now;
}

bool is_followed(const std::vector<Arrival>& paths, const Arrival& before) {
  constexpr double kSameRay = 1e-8;  // rad
  const Arrival& now = paths.back();
  const bool same = now.surface_bounces == before.surface_bounces &&
                    now.bottom_bounces == before.bottom_bounces && now.caustics == before.caustics &&
                    now.identity.launched_up == before.identity.launched_up;
  return same && std::none_of(paths.begin(), paths.end() - 1, [&now](const Arrival& other) {
           return std::abs(other.launch_angle_rad - now.launch_angle_rad) < kSameRay &&
                  other.identity.surface_bounces == now.identity.surface_bounces &&
                  other.identity.bottom_bounces == now.identity.bottom_bounces;
         });
}

void validate(const RayOptions& options) {
  require_in_range(options.frequency_hz, 10, 1e6, "ray frequency", "Hz");
  require_in_range(options.max_launch_angle_rad, 1e-6, pi / 2, "greatest launch angle", "rad");
  require_in_range(options.max_bounces, 0, 10'000, "greatest number of bounces");
  require_in_range(options.min_boundary_factor, 0, 0.999, "least factor of all bounces");
  require_in_range(options.min_amplitude, 0, 1e6, "least amplitude");
}

void finish(std::vector<Arrival>& paths, const RayOptions& options) {
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
