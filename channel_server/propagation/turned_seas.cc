// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/turned_seas.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <span>
#include <tuple>

#include "acoustics/rays/traced_eigenray.h"
#include "acoustics/sea/ice_cover.h"
#include "acoustics/sea/surface/surface_boundary.h"
#include "channel_server/propagation/seabed_profile.h"
#include "core/elementary.h"
#include "core/hash.h"
#include "core/units.h"

namespace halocline::channel_server {
namespace {

constexpr std::size_t kMaxSeas = 64;  // cached, up to 3 MB each
constexpr std::size_t kStretches = 8;
constexpr double kDepthRatio = 1.05;  // between depths of transports over an uneven bottom
constexpr double kAlike = 1.1;        // ratio of the greatest to the least depth of a stretch
constexpr double kWindStepMps = 0.1;
constexpr int kNodesOfDepth = 50;      // depths of ends
constexpr double kNearBoundary = 0.2;  // share of the depth
constexpr double kSlopeStep = 0.02;    // rms slopes of relief are counted in these
constexpr double kCyclesOfFocus = 3, kMaxFocus = 2;
constexpr double kNegligible = 1e-6;  // share of the whole power below which a path is left out
constexpr double kLevelM = 1e-6;
// Share of a stretch's mean depth below which its least depth holds sound back.
constexpr double kShoal = 0.2;
// Ranges, in depths, from which turned sound counts, and from which all of it does.
constexpr double kSteepEnds = 1, kFilled = 2;

double power_of(const acoustics::Eigenray& path) {
  const double pressure = path.received_pressure();
  return pressure * pressure;
}

int bounces_of(const acoustics::Eigenray& path) { return path.surface_bounces + path.bottom_bounces; }

double relief_slope(const TurnedLink& link) {
  return kSlopeStep * std::round(std::sqrt(link.mean_square_slope) / kSlopeStep);
}

acoustics::RaySurface counted_surface(const TurnedLink& link) {
  acoustics::RaySurface surface = link.surface;
  surface.wind_mps = std::round(surface.wind_mps / kWindStepMps) * kWindStepMps;
  return surface;
}

// Hash of all values that transports of the link depend on, but for depth and bins.
std::uint64_t hash_of(const TurnedLink& link) {
  std::vector<double> values{link.frequency_hz,
                             counted_surface(link).wind_mps,
                             static_cast<double>(link.surface.model),
                             link.bottom.density_ratio,
                             link.bottom.sound_speed_ratio,
                             link.bottom.sound_speed_mps,
                             link.bottom.loss_parameter,
                             static_cast<double>(link.bottom.loss),
                             link.fading.bottom_roughness_m,
                             link.fading.bottom_slope,
                             relief_slope(link),
                             link.medium.speed_mps,
                             link.medium.internal_wave_m};
  const acoustics::IceCover& ice = link.surface.ice;
  if (ice.covers())
    values.insert(values.end(), {ice.roughness_m, ice.slope, ice.loss_db, ice.loss_per_sine_db});
  const acoustics::RayWater& water = link.water;
  values.insert(values.end(), water.depths_m().begin(), water.depths_m().end());
  values.insert(values.end(), water.speeds_mps().begin(), water.speeds_mps().end());
  for (const acoustics::LayerAbsorption& layer : water.absorption())
    values.insert(values.end(), {layer.a0, layer.a1, layer.a2});
  std::uint64_t hash = 0;
  for (const double value : values) {
    const auto bytes = std::bit_cast<std::array<std::uint8_t, sizeof value>>(value + 0.0);
    hash = xxh3(std::span<const std::uint8_t>(bytes), hash);
  }
  return hash;
}

// The part of a link over one depth.
struct DepthStretch {
  double depth_m, length_m;  // of the sea
  double model_m;            // depth of its transport
};

bool is_level(const TurnedLink& link) {
  const auto [least, most] = std::minmax_element(link.depths_m.begin(), link.depths_m.end());
  return *most - *least < kLevelM;
}

// The depth to three digits.
double three_digits(double depth_m) {
  double unit_m = 1e-3;
  while (unit_m * 999.5 < depth_m) unit_m *= 10;
  return std::max(std::round(depth_m / unit_m), 1.0) * unit_m;
}

// The eighth of the link's depths.
double depth_of_eighth(const TurnedLink& link, std::size_t i) {
  return 0.5 * (link.depths_m[2 * i] + link.depths_m[2 * i + 1]);
}

std::vector<DepthStretch> stretches_of(const TurnedLink& link) {
  const double range_m = std::max(link.link.range_m, acoustics::kMinDistance);
  if (is_level(link)) return {{link.depths_m.front(), range_m, three_digits(link.depths_m.front())}};
  std::vector<DepthStretch> stretches;
  const double unit = elementary::log(kDepthRatio);
  for (std::size_t begin = 0, end = 0; begin < kStretches; begin = end) {
    double least = depth_of_eighth(link, begin), most = least, sum = 0;
    for (; end < kStretches; ++end) {
      const double depth_m = depth_of_eighth(link, end);
      least = std::min(least, depth_m);
      most = std::max(most, depth_m);
      if (most > kAlike * least) break;
      sum += depth_m;
    }
    const auto eighths = static_cast<double>(end - begin);
    const double depth_m = sum / eighths;
    const double model_m = elementary::exp(unit * std::round(elementary::log(depth_m) / unit));
    stretches.push_back({depth_m, range_m * eighths / kStretches, model_m});
  }
  return stretches;
}

// Share of the power that passes the shoals of a link: 0 over land, all where the least depth of each stretch
// is a fifth of its mean or more (choice). Rays keep depth times sine, so that the steep ones do not pass.
double passing_share(const TurnedLink& link) {
  if (is_level(link)) return 1;
  double share = 1;
  for (std::size_t i = 0; i < kStretches; ++i) {
    const double one_m = link.depths_m[2 * i], other_m = link.depths_m[2 * i + 1];
    const double open_m = std::min(one_m, other_m) - kMinWaterM;
    share = std::min(share, std::max(open_m, 0.0) / (kShoal * 0.5 * (one_m + other_m)));
  }
  return share;
}

// Deviation of the sound speed by the medium in each layer of the water, and below the last one.
std::vector<double> speed_deviations(const TurnedLink& link) {
  if (link.medium.is_perfect()) return {};
  const std::vector<double>&depths_m = link.water.depths_m(), &speeds_mps = link.water.speeds_mps();
  std::vector<double> deviations;
  for (std::size_t i = 0; i + 1 < depths_m.size(); ++i) {
    const double gradient = (speeds_mps[i + 1] - speeds_mps[i]) / (depths_m[i + 1] - depths_m[i]);
    deviations.push_back(std::sqrt(link.medium.speed_variance(gradient)));
  }
  deviations.push_back(std::sqrt(link.medium.speed_variance(0)));
  return deviations;
}

acoustics::TransportSea transport_sea(const TurnedLink& link, double depth_m, std::size_t bins) {
  const double slope = relief_slope(link);
  acoustics::TransportSea sea{
      link.water, depth_m, link.frequency_hz,
      acoustics::scattering_surface(counted_surface(link), link.frequency_hz),
      acoustics::rough_bottom(link.bottom, link.water.speed_at(depth_m), link.fading.bottom_roughness_m,
                              link.fading.bottom_slope * link.fading.bottom_slope)};
  sea.bottom.relief_variance = slope * slope;
  sea.speed_deviation_mps = speed_deviations(link);
  sea.bins = bins;
  return sea;
}

}  // namespace

// Both directions of a link, in its own scale.
struct TurnedSeas::Turned {
  acoustics::TurnedSound forward, backward;
  double depth_m = 0;  // mean
  double total() const {
    return 0.5 * (forward.power + forward.unbounced + backward.power + backward.unbounced);
  }
};

TurnedSeas::TurnedSeas() : seas_(kMaxSeas) {}

std::shared_ptr<TurnedSeas::Sea> TurnedSeas::sea_of(const TurnedLink& link, std::uint64_t hash,
                                                    double depth_m, std::size_t bins) const {
  const Key key{hash, depth_m, bins};
  {
    const std::lock_guard lock(mutex_);
    if (const auto* known = seas_.find(key)) return *known;
  }
  auto sea = std::make_shared<Sea>(transport_sea(link, depth_m, bins));
  const std::lock_guard lock(mutex_);
  return seas_.find_or_make(key, [&] { return std::move(sea); });
}

// Ends without a table have even slots.
std::shared_ptr<const acoustics::TransportEnd> TurnedSeas::node_of(Sea& sea, int slot) {
  {
    const std::lock_guard lock(sea.mutex);
    const auto known = sea.ends.find(slot);
    if (known != sea.ends.end()) return known->second;
  }
  const double depth_m = sea.transport.depth_m() * (slot / 2) / kNodesOfDepth;
  auto end = std::make_shared<const acoustics::TransportEnd>(sea.transport, depth_m, slot % 2 == 1);
  const std::lock_guard lock(sea.mutex);
  return sea.ends.emplace(slot, std::move(end)).first->second;
}

namespace {

// The greatest distance at which a link of `range_m` looks into the tables of its ends: of rays that never
// bounce a quarter of a cycle more.
double reach_of(const acoustics::AngleTransport& transport, double range_m) {
  double cycle_m = 0;
  for (const acoustics::TransportState& state : transport.states())
    if (state.surface_sine == 0 && state.bottom_sine == 0) cycle_m = std::max(cycle_m, state.cycle_m);
  return range_m + cycle_m / 4;
}

// Sound computed over model depths and ranges, as it is over the true ones: intensities go with the inverse
// square of the scale in even water, delays with the range, absorption by the difference of range.
void rescale(acoustics::TurnedSound& sound, double power_scale, double delay_scale) {
  sound.power *= power_scale;
  sound.unbounced *= power_scale;
  sound.reference_s *= delay_scale;
  for (acoustics::TurnedPart& part : sound.parts) {
    part.power *= power_scale;
    part.excess_s *= delay_scale;
    part.variance_s2 *= delay_scale * delay_scale;
  }
}

}  // namespace

TurnedSeas::Turned TurnedSeas::turned(const TurnedLink& link) const {
  const std::vector<DepthStretch> parts = stretches_of(link);
  const double source = link.link.source_depth_m / link.depths_m.front();
  const double receiver = link.link.receiver_depth_m / link.depths_m.back();
  const auto is_near = [](double share) { return share < kNearBoundary || share > 1 - kNearBoundary; };
  const std::size_t bins = is_near(source) || is_near(receiver) ? 96 : 48;
  const std::uint64_t hash = hash_of(link);
  std::vector<std::shared_ptr<Sea>> seas;
  std::vector<acoustics::Stretch> there;
  double range_m = 0, model_range_m = 0, depth_m = 0, absorbed_db = 0;
  for (const DepthStretch& part : parts) {
    seas.push_back(sea_of(link, hash, part.model_m, bins));
    const double length_m = part.length_m * part.model_m / part.depth_m;
    there.push_back({{seas.back(), &seas.back()->transport}, length_m});
    range_m += part.length_m;
    model_range_m += length_m;
    depth_m += part.length_m * part.depth_m;
    absorbed_db += (part.length_m - length_m) * link.water.absorption_db_per_m(0.5 * part.model_m);
  }
  const std::vector<acoustics::Stretch> back(there.rbegin(), there.rend());
  const double reach_m = there.size() == 1 ? reach_of(seas.front()->transport, model_range_m) : 0;
  // The end at a share of the depth, with a table up to `reach_m` or, where that is 0, without one.
  const auto end_at = [reach_m](Sea& sea, double share_of_depth) {
    const double place = std::clamp(share_of_depth, 0.0, 1.0) * kNodesOfDepth;
    const int node = std::min(static_cast<int>(place), kNodesOfDepth - 1);
    const int slot = 2 * node + (reach_m > 0 ? 1 : 0);
    constexpr double kAtNode = 1e-9;
    const double share = place - node;
    if (share < kAtNode) return *node_of(sea, slot);
    if (share > 1 - kAtNode) return *node_of(sea, slot + 2);
    return acoustics::TransportEnd::between(*node_of(sea, slot), *node_of(sea, slot + 2), share, reach_m);
  };
  const acoustics::TransportEnd first = end_at(*seas.front(), source), last = end_at(*seas.back(), receiver);
  Turned turned;
  turned.depth_m = depth_m / range_m;
  if (there.size() == 1) {
    turned.forward = acoustics::turned_sound(seas.front()->transport, first, last, model_range_m);
    turned.backward = acoustics::turned_sound(seas.front()->transport, last, first, model_range_m);
  } else {
    turned.forward = acoustics::turned_sound(there, first, last);
    turned.backward = acoustics::turned_sound(back, last, first);
  }
  const double longer = range_m / model_range_m;
  const double absorbed = elementary::exp10(-absorbed_db / 10);
  const double scale = absorbed / longer * passing_share(link);
  rescale(turned.forward, scale * parts.back().model_m / parts.back().depth_m, longer);
  rescale(turned.backward, scale * parts.front().model_m / parts.front().depth_m, longer);
  return turned;
}

namespace {

// The windows as paths that are diffuse. A window of the excess delay t over the range r has run at the mean
// angle of cos = reference / (reference + t) and bounced r tan(angle) / (2 H) times at each boundary.
std::vector<acoustics::Eigenray> paths_of(const TurnedLink& link, double reference_s, double depth_m,
                                          double factor, const std::vector<acoustics::DelayWindow>& windows) {
  const double range_m = std::max(link.link.range_m, acoustics::kMinDistance);
  const double db_per_m = link.water.absorption_db_per_m(depth_m / 2);
  std::vector<acoustics::Eigenray> paths;
  for (const acoustics::DelayWindow& window : windows) {
    const double power = factor * window.power;
    if (!(power > 0)) continue;
    const double cosine = reference_s / (reference_s + window.excess_s);
    const double sine = std::sqrt((1 - cosine) * (1 + cosine));
    const double bounces = range_m * sine / cosine / (2 * depth_m);
    acoustics::Eigenray path;
    path.delay_s = reference_s + window.excess_s;
    path.path_length_m = range_m / cosine;
    path.absorption_db = db_per_m * path.path_length_m;
    path.amplitude = std::sqrt(power) * elementary::exp10(path.absorption_db / 20);
    path.launch_angle_rad = elementary::asin(std::min(window.launch_sine, 1.0));
    path.arrival_angle_rad = elementary::asin(std::min(window.arrival_sine, 1.0));
    path.launch_slowness_spm = path.range_slowness_spm = path.delay_s / range_m;
    path.surface_sine_squares = path.bottom_sine_squares = bounces * sine * sine;
    path.surface_bounces = path.bottom_bounces = static_cast<int>(std::min(bounces, 1e4));
    path.diffuse = true;
    path.identity = acoustics::diffuse_identity(path.launch_angle_rad, paths.size());
    paths.push_back(path);
  }
  return paths;
}

double reference_of(const acoustics::TurnedSound& forward, const acoustics::TurnedSound& backward) {
  return 0.5 * (forward.reference_s + backward.reference_s);
}

// Cycles of a path: meetings of the surface or upper turns, and those below, whichever are more.
int cycles_of(const acoustics::Eigenray& path) {
  return std::max(path.surface_bounces + path.identity.upper_turns,
                  path.bottom_bounces + path.identity.lower_turns);
}

// What each traced path keeps of its power.
std::vector<double> kept_powers(const TurnedLink& link, const std::vector<acoustics::Eigenray>& paths) {
  const double surface_m =
      surface_boundary(link.surface.wind_mps, link.surface.ice, link.frequency_hz).rms_height_m;
  std::vector<double> kept;
  for (const acoustics::Eigenray& path : paths) {
    const double share = bounces_of(path) < 2
                             ? 1
                             : acoustics::coherent_share(link.fading, surface_m, link.frequency_hz,
                                                         path.surface_sine_squares, path.bottom_sine_squares);
    kept.push_back(share * power_of(path));
  }
  return kept;
}

// Share of the turned sound that a range of so many depths has. Energy flux spreads the sound of each angle
// over the whole depth, which steep rays fill only after a cycle or so: within one depth there are traced
// paths alone.
double filled_share(double depths) {
  return std::clamp((depths - kSteepEnds) / (kFilled - kSteepEnds), 0.0, 1.0);
}

// Share q of a path that the transport limits: all of one of more than three cycles, and of others what fine
// structure spreads over the whole depth H. It spreads a ray by sigma_z = sqrt(mu r^3 / 3), to both sides:
//   q = 1 - exp(-(2 sigma_z / H)^2).
double limited_share(const TurnedLink& link, double depth_m, const acoustics::Eigenray& path) {
  if (cycles_of(path) > kCyclesOfFocus) return 1;
  if (link.medium.is_perfect()) return 0;
  const double r = std::max(link.link.range_m, acoustics::kMinDistance);
  const double mu = cycle_turning_rate(link.water, link.medium, depth_m, link.link.source_depth_m,
                                       path.launch_slowness_spm);
  return -elementary::expm1(-4 * mu * r * r * r / (3 * depth_m * depth_m));
}

// The power that paths may have, of which a share has bounced, so that they and the windows, which make up
// for what bounced paths lack of the turned power A, have twice the transport's total T.
double greatest_sum(double total, double turned, double bounced_share) {
  const double most = kMaxFocus * total;
  return bounced_share * most < turned ? (most - turned) / (1 - bounced_share) : most;
}

// Limits what focuses beyond the transport's sound. A path of the power `kept` keeps (1 - q) + q min(1, X /
// S) of its power, S the sum of all paths' shares q and X their greatest_sum().
void limit_focus(const TurnedLink& link, double depth_m, double total, double turned,
                 std::vector<acoustics::Eigenray>& paths, std::vector<double>& kept) {
  double all = 0;
  for (const double power : kept) all += power;
  if (!(total > 0) || !(all > greatest_sum(total, turned, 0))) return;
  std::vector<double> shares;
  double sum = 0, bounced = 0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const double limited = kept[i] * shares.emplace_back(limited_share(link, depth_m, paths[i]));
    sum += limited;
    if (bounces_of(paths[i]) > 0) bounced += limited;
  }
  if (!(sum > 0)) return;
  const double most = greatest_sum(total, turned, bounced / sum);
  if (!(sum > most)) return;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const double scale = 1 - shares[i] * (1 - most / sum);
    paths[i].amplitude *= std::sqrt(scale);
    kept[i] *= scale;
  }
}

}  // namespace

std::vector<acoustics::Eigenray> TurnedSeas::windows_alone(const TurnedLink& link) const {
  const Turned sound = turned(link);
  const acoustics::DelaySpectrum spectrum(sound.forward, sound.backward);
  return paths_of(link, reference_of(sound.forward, sound.backward), sound.depth_m, 1, spectrum.windows());
}

std::vector<acoustics::Eigenray> TurnedSeas::with_turned_sound(const TurnedLink& link,
                                                               std::vector<acoustics::Eigenray> paths) const {
  const Turned sound = turned(link);
  const acoustics::DelaySpectrum spectrum(sound.forward, sound.backward);
  paths.erase(std::remove_if(paths.begin(), paths.end(), [](const auto& path) { return path.diffuse; }),
              paths.end());
  const double first_s = paths.empty() ? 0 : paths.front().delay_s;  // no sound is faster: Fermat
  std::vector<double> kept = kept_powers(link, paths);
  limit_focus(link, sound.depth_m, sound.total(), spectrum.power(), paths, kept);
  double bounced = 0, all = 0, most = 0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (bounces_of(paths[i]) > 0) bounced += kept[i];
    all += kept[i];
    most = std::max(most, kept[i]);
  }
  const double turned_power = spectrum.power();
  const double factor = turned_power > 0 ? filled_share(link.link.range_m / sound.depth_m) *
                                               std::clamp(1 - bounced / turned_power, 0.0, 1.0)
                                         : 0;
  const double least = std::min(kNegligible * (all + factor * turned_power), most);
  std::size_t left = 0;
  for (std::size_t i = 0; i < paths.size(); ++i)
    if (kept[i] >= least) paths[left++] = paths[i];
  paths.resize(left);
  std::vector<acoustics::Eigenray> windows =
      paths_of(link, reference_of(sound.forward, sound.backward), sound.depth_m, factor, spectrum.windows());
  for (acoustics::Eigenray& window : windows) window.delay_s = std::max(window.delay_s, first_s);
  paths.insert(paths.end(), windows.begin(), windows.end());
  std::stable_sort(paths.begin(), paths.end(),
                   [](const auto& a, const auto& b) { return a.delay_s < b.delay_s; });
  return paths;
}

}  // namespace halocline::channel_server
