// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/coverage/coverage_links.h"

#include <algorithm>
#include <utility>

#include "acoustics/modem/modem.h"
#include "bus/runtime/thread_pool.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "core/elementary.h"
#include "core/sim_time.h"

namespace halocline::clients {
namespace {

// Returns the order in which depths are computed: the first and the last, then the middle between them, the
// middles of the halves, of the quarters, and so on, because paths are interpolated between depths above and
// below.
std::vector<std::size_t> ends_first(std::size_t count) {
  if (count == 0) return {};
  std::vector<std::size_t> order{0};
  if (count > 1) order.push_back(count - 1);
  std::vector<std::pair<std::size_t, std::size_t>> spans{{0, count - 1}};
  for (std::size_t next = 0; next < spans.size(); ++next) {
    const auto [first, last] = spans[next];
    if (last - first < 2) continue;
    const std::size_t middle = first + (last - first) / 2;
    order.push_back(middle);
    spans.emplace_back(first, middle);
    spans.emplace_back(middle, last);
  }
  return order;
}

}  // namespace

CoverageLinks::CoverageLinks(const Scene& scene)
    : config_(scene.config),
      terrain_(scene.terrain),
      from_(scene.from),
      to_(make_modems(scene.config.channel_server).standard),
      sources_(read_water(scene.config.channel_server, scene.config.scenario)) {}

void CoverageLinks::share(int threads, std::size_t count,
                          const std::function<void(LinkSurveyor&, std::size_t)>& item) const {
  const auto stride = static_cast<std::size_t>(threads);
  bus::ThreadPool(threads).for_each(stride, [&](std::size_t thread) {
    LinkSurveyor own = surveyor();
    for (std::size_t i = thread; i < count; i += stride) item(own, i);
  });
}

bool CoverageLinks::along_rays() const {
  return config_.channel_server.propagation.model == channel_server::PropagationModel::kRays;
}

bool CoverageLinks::is_among_noise() const {
  const auto& vehicles = config_.channel_server.vehicles;
  return std::any_of(vehicles.begin(), vehicles.end(), [](const auto& vehicle) { return vehicle.noise; });
}

double CoverageLinks::noise_level_db() const { return surveyor().noise_level(from_.modem.modem).value; }

channel_server::SeabedMap CoverageLinks::seabed_map() const {
  return channel_server::SeabedMap(config_.channel_server.rules.seabed);
}

void CoverageLinks::survey(const Vec3& to_ned_m, channel_server::SeabedMap& seabed) const {
  while (along_rays() && !seabed.is_surveyed(from_.position_ned_m, to_ned_m))
    answer_requests(*terrain_, seabed);
}

LinkSurveyor::Seabed CoverageLinks::bottom(const Vec3& to_ned_m,
                                           const channel_server::SeabedMap& seabed) const {
  return along_rays() ? seabed.between(from_.position_ned_m, to_ned_m) : nullptr;
}

Sample CoverageLinks::sample(LinkSurveyor& surveyor, const Vec3& to_ned_m, const LinkSurveyor::Seabed& seabed,
                             channel_server::SharedLine* line) const {
  const acoustics::Modem& transmitter = from_.modem.modem;
  const channel_server::LinkEnd here{0, from_.position_ned_m, Vec3::Zero(), &transmitter};
  const channel_server::LinkEnd there{0, to_ned_m, Vec3::Zero(), &receiving_modem(to_, transmitter)};
  const LinkSurveyor::Answer answer = surveyor.survey(here, there, seabed, line);
  return {answer.forecast.delivery_probability, answer.reception.budget.received_level.value,
          answer.reception.budget.delay_s,      answer.reception.budget.snr.value,
          answer.forecast.delivery_low,         answer.forecast.delivery_high};
}

std::vector<Sample> CoverageLinks::links(LinkSurveyor& surveyor, const Vec3& place_ned_m,
                                         const std::vector<double>& z_m, const LinkSurveyor::Seabed& seabed,
                                         channel_server::SharedLine* line) const {
  std::vector<Sample> samples(z_m.size());
  for (const std::size_t i : ends_first(z_m.size()))
    samples[i] = sample(surveyor, {place_ned_m.x(), place_ned_m.y(), z_m[i]}, seabed, line);
  return samples;
}

std::vector<Sample> CoverageLinks::links_to_one_place(LinkSurveyor& surveyor, const Vec3& place_ned_m,
                                                      const std::vector<double>& z_m,
                                                      const LinkSurveyor::Seabed& seabed,
                                                      RaySharing sharing) const {
  if (sharing == RaySharing::kNone) return links(surveyor, place_ned_m, z_m, seabed, nullptr);
  channel_server::SharedLine depths = channel_server::SharedLine::of_depths();
  return links(surveyor, place_ned_m, z_m, seabed, &depths);
}

acoustics::BottomProfile CoverageLinks::bottom_profile(const Vec3& to_ned_m,
                                                       const channel_server::SeabedProfile& seabed) const {
  const Vec3 way = to_ned_m - from_.position_ned_m;
  return bottom_under(seabed, {0, 0, elementary::hypot(way.x(), way.y())}, environment().sea_surface_z_m);
}

}  // namespace halocline::clients
