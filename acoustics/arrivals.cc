#include "acoustics/arrivals.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <tuple>

#include "core/check.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

// Nearer in both, two paths of one kind are the two sides of a fold that no receiver can tell apart.
constexpr double kMergedDelay = 1e-6;                  // s
const double kMergedAngle = to_radians(0.02);

auto kind(const Arrival& path) {
  const PathIdentity& id = path.identity;
  return std::tuple(id.launched_up, id.surface_bounces, id.bottom_bounces, id.upper_turns, id.lower_turns);
}

bool are_one_fold(const Arrival& a, const Arrival& b) {
  return kind(a) == kind(b) && std::abs(a.delay_s - b.delay_s) < kMergedDelay &&
         std::abs(a.launch_angle_rad - b.launch_angle_rad) < kMergedAngle;
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

void merge_folds(std::vector<Arrival>& paths, double frequency_hz) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (kept > 0 && are_one_fold(paths[kept - 1], paths[i])) {
      paths[kept - 1] = merged(paths[kept - 1], paths[i], frequency_hz);
    } else {
      paths[kept++] = paths[i];
    }
  }
  paths.resize(kept);
}

void number_branches(std::vector<Arrival>& paths) {
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const bool same = i > 0 && kind(paths[i - 1]) == kind(paths[i]);
    paths[i].identity.branch = same ? paths[i - 1].identity.branch + 1 : 0;
  }
}

}  // namespace

double Arrival::received_pressure() const { return amplitude * std::pow(10.0, -absorption_db / 20); }

std::string_view to_name(RaySolver solver) {
  switch (solver) {
    case RaySolver::kImages: return "images";
    case RaySolver::kSnell: return "snell";
    case RaySolver::kArcs: return "arcs";
  }
  return "";
}

bool Arrivals::has_direct_path() const {
  return std::any_of(paths.begin(), paths.end(), [](const Arrival& path) {
    return path.surface_bounces == 0 && path.bottom_bounces == 0;
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
  std::erase_if(paths, [&options](const Arrival& path) { return path.amplitude < options.min_amplitude; });
  std::sort(paths.begin(), paths.end(), [](const Arrival& a, const Arrival& b) {
    return std::tuple(kind(a), a.launch_angle_rad) < std::tuple(kind(b), b.launch_angle_rad);
  });
  merge_folds(paths, options.frequency_hz);
  number_branches(paths);
  std::sort(paths.begin(), paths.end(), [](const Arrival& a, const Arrival& b) {
    return std::tuple(a.delay_s, a.launch_angle_rad) < std::tuple(b.delay_s, b.launch_angle_rad);
  });
}

}  // namespace halocline::acoustics
