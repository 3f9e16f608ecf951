// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/propagation.h"

#include "acoustics/modem/beam_pattern.h"
#include "core/check.h"
#include "core/elementary.h"

namespace halocline::channel_server {
namespace {

template <class Counts>
Decibels summed_level(const std::vector<Arrival>& paths, const Counts& counts) {
  PowerRatio sum;
  for (const Arrival& path : paths) {
    if (counts(path)) sum = sum + to_power_ratio(path.level);
  }
  return sum.value > 0 ? std::max(to_decibels(sum), kSilence) : kSilence;
}

}  // namespace

std::size_t first_significant(const std::vector<Arrival>& paths) {
  const auto strongest = std::max_element(
      paths.begin(), paths.end(), [](const Arrival& a, const Arrival& b) { return a.level < b.level; });
  const Decibels least = strongest->level - kSignificantBelowStrongest;
  const auto first =
      std::find_if(paths.begin(), strongest, [&](const Arrival& path) { return path.level >= least; });
  return static_cast<std::size_t>(first - paths.begin());
}

double delay_spread_s(const std::vector<Arrival>& paths) {
  if (paths.size() < 2) return 0;
  const Arrival& first = paths[first_significant(paths)];
  Decibels strongest = first.level;
  for (const Arrival& path : paths) strongest = std::max(strongest, path.level);
  const auto last = std::find_if(paths.rbegin(), paths.rend(), [&](const Arrival& path) {
    return path.level >= strongest - kSignificantBelowStrongest;
  });
  return last->delay_s - first.delay_s;
}

Decibels total_level(const std::vector<Arrival>& paths) {
  return summed_level(paths, [](const Arrival&) { return true; });
}

std::size_t number_of_paths(const std::vector<Arrival>& paths) {
  return static_cast<std::size_t>(
      std::count_if(paths.begin(), paths.end(), [](const Arrival& path) { return !path.diffuse; }));
}

Decibels diffuse_level(const std::vector<Arrival>& paths) {
  return summed_level(paths, [](const Arrival& path) { return path.diffuse; });
}

LinkChart Propagation::chart(SimTime at, const LinkEnd& from, const LinkEnd& to) {
  const Reception reception = this->reception(at, from, to);
  const double surface_z_m = environment(at).sea_surface_z_m;
  const Vec3 way = to.position_ned_m - from.position_ned_m;
  LinkChart chart{.link = {depth_below_surface_m(from.position_ned_m, surface_z_m),
                           depth_below_surface_m(to.position_ned_m, surface_z_m),
                           elementary::hypot(way.x(), way.y())}};
  for (const Arrival& path : reception.paths) {
    LinkChart::Row row{.arrival = path};
    row.beam_db =
        (from.modem->beam.loss(path.launch_angle_rad) + to.modem->beam.loss(-path.arrival_angle_rad)).value;
    row.spreading_db = (from.modem->source_level - path.level).value - path.absorption_db - row.beam_db;
    if (!reception.measured)
      row.course = {{0, chart.link.source_depth_m}, {chart.link.range_m, chart.link.receiver_depth_m}};
    chart.rows.push_back(std::move(row));
  }
  chart.keep_strongest();
  chart.weigh(reception.paths, *to.modem);
  return chart;
}

std::vector<std::optional<Reception>> Propagation::packet_receptions(SimTime at,
                                                                     const std::vector<EndPair>& links,
                                                                     const ForEach& /*for_each*/) {
  std::vector<std::optional<Reception>> receptions(links.size());
  for (std::size_t i = 0; i < links.size(); ++i) {
    const auto& [from, to] = links[i];
    if (is_ready_for_packet(at, from, to)) receptions[i] = reception_without_capacity(at, from, to);
  }
  return receptions;
}

std::vector<Reception> Propagation::receptions(SimTime at, const std::vector<EndPair>& links,
                                               const ForEach&) {
  std::vector<Reception> receptions;
  for (const EndPair& link : links) receptions.push_back(reception(at, link.from, link.to));
  return receptions;
}

Reception Propagation::reception_over(SimTime, const LinkEnd&, const LinkEnd&,
                                      const std::shared_ptr<const SeabedProfile>&) {
  ensure(false, "reception_over() of a propagation without a bottom");
  return {};
}

}  // namespace halocline::channel_server
