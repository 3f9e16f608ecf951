// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/pages/link_view.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "core/elementary.h"
#include "core/frames.h"
#include "runs/timeline/link_history.h"
#include "runs/timeline/packet_book.h"

namespace halocline::monitor {
namespace {

using nlohmann::json;

constexpr const char* kLevel = "dB re 1 uPa";

link_end_t end_of(const clients::VehicleRecord& vehicle, const Vec3& place) {
  link_end_t end{};
  end.vehicle_name = vehicle.name;
  for (int i = 0; i < 3; ++i) end.position_ned_m[i] = place[i];
  end.modem_choice = link_end_t::MODEM_SCENARIO;
  return end;
}

json rounded(std::span<const float> values, double offset) {
  json all = json::array();
  for (const float value : values)
    all.push_back(std::round((static_cast<double>(value) + offset) * 100) / 100);
  return all;
}

json paths_json(const link_paths_t& paths, double surface_m) {
  std::vector<json> all;
  for (const arrival_t& path : paths.paths) {
    all.push_back({{"delay_s", path.path_delay_s},
                   {"level_db", path.path_level_db - paths.source_level_db},
                   {"phase_rad", path.phase_rad},
                   {"surface_bounces", path.surface_bounces},
                   {"bottom_bounces", path.bottom_bounces},
                   {"caustics", path.caustics},
                   {"launch_rad", path.launch_angle_rad},
                   {"arrival_rad", path.arrival_angle_rad},
                   {"weight", path.guard_weight},
                   {"range_m", json::array()},
                   {"depth_m", json::array()}});
  }
  for (std::size_t i = 0; i < paths.point_path.size(); ++i) {
    const auto path = static_cast<std::size_t>(paths.point_path[i]);
    if (path >= all.size()) continue;
    all[path]["range_m"].push_back(std::round(paths.point_range_m[i] * 10) / 10);
    all[path]["depth_m"].push_back(std::round((paths.point_depth_m[i] + surface_m) * 100) / 100);
  }
  std::stable_sort(all.begin(), all.end(), [](const json& a, const json& b) {
    return a["level_db"].get<double>() > b["level_db"].get<double>();
  });
  return all;
}

// Rows of a waterfall chart: steps add to the start, totals show the sum so far.
class Waterfall {
 public:
  void start(const char* label, double value, const char* unit, const char* help) {
    sum_ = value;
    add(label, "start", value, unit, json(), help);
  }
  void step(const char* label, double value, const char* help) {
    sum_ += value;
    add(label, "step", value, "dB", json(), help);
  }
  // Adds a total. The caller adds a step before it for any difference of more than rounding.
  void total(const char* label, double value, const char* unit, const json& limit, const char* help) {
    sum_ = value;
    add(label, "total", value, unit, limit, help);
  }
  double sum() const { return sum_; }
  json take() { return std::move(rows_); }

 private:
  void add(const char* label, const char* kind, double value, const char* unit, const json& limit,
           const char* help) {
    rows_.push_back({{"label", label},
                     {"kind", kind},
                     {"value", value},
                     {"unit", unit},
                     {"limit", limit},
                     {"help", help}});
  }
  json rows_ = json::array();
  double sum_ = 0;
};

// From SNR to SINR = 1 / (noise + late echoes + fast fading + impulses), each over the signal. A step for
// each power: what it takes after those before it.
void add_receiver(const link_t& link, Waterfall& fall) {
  constexpr double kNone_db = -200, kShown_db = 0.005;
  fall.step("Receiver", -link.noise_db - link.snr_db,
            "Its loss and its hydrophones, and sound outside of its guard window, which adds no signal.");
  double sum = elementary::exp10(link.noise_db / 10);
  const auto add = [&](const char* label, double over_signal_db, const char* help) {
    if (over_signal_db < kNone_db) return;
    const double before = sum;
    sum += elementary::exp10(over_signal_db / 10);
    const double taken_db = 10 * elementary::log10(sum / before);
    if (taken_db > kShown_db) fall.step(label, -taken_db, help);
  };
  add("Late echoes", link.late_echo_db, "Paths outside of the guard window disturb instead of adding.");
  add("Fast fading", link.fast_fading_db, "Sound that fades or shifts faster than the receiver follows.");
  add("Impulses", link.impulse_db, "Impulses of the sea's noise, by the receiver's loss.");
}

json threshold_of(const LinkSubject& link) { return link.threshold_db ? json(*link.threshold_db) : json(); }

json budget_json(const LinkSubject& subject, const link_t& link, const link_paths_t& paths) {
  constexpr double kRounding_db = 0.005;
  Waterfall fall;
  // A channel server that reports no paths leaves the source level out (0).
  const bool is_known = paths.source_level_db > 0;
  fall.start("Source level",
             is_known ? paths.source_level_db : link.received_level_db + link.transmission_loss_db,
             "dB re 1 uPa at 1 m", "Of the sender's modem.");
  const auto strongest = std::max_element(
      paths.paths.begin(), paths.paths.end(),
      [](const arrival_t& a, const arrival_t& b) { return a.path_level_db < b.path_level_db; });
  if (strongest != paths.paths.end()) {
    fall.step("Spreading", -strongest->spreading_loss_db, "Of the strongest path's ray tube.");
    fall.step("Absorption", -strongest->absorption_loss_db, "Along the strongest path.");
    if (strongest->surface_bounces > 0)
      fall.step("Surface", -strongest->surface_loss_db, "Of its bounces at the surface.");
    if (strongest->bottom_bounces > 0)
      fall.step("Bottom", -strongest->bottom_loss_db, "Of its bounces at the bottom.");
    if (std::abs(strongest->beam_loss_db) > kRounding_db)
      fall.step("Beams", -strongest->beam_loss_db, "Of both transducers in its directions.");
    const double others = link.received_level_db - fall.sum();
    if (std::abs(others) > kRounding_db)
      fall.step("All other paths", others, "What they add to the strongest one.");
  } else {
    fall.step("Transmission loss", -link.transmission_loss_db, "Spreading and absorption.");
  }
  const auto& receiver = subject.to.modem;
  const json cutoff = receiver ? json(receiver->cutoff_level_db) : json();
  fall.total("Received level", link.received_level_db, kLevel, cutoff,
             "Sum of all paths, against the receiver's least receivable level.");
  fall.step("Noise", -link.noise_level_db, "At the receiver, over the sender's band.");
  const double directivity = link.snr_db - fall.sum();
  if (std::abs(directivity) > kRounding_db)
    fall.step("Directivity", directivity, "Noise from elsewhere that the receiver's transducer leaves out.");
  fall.total("SNR", link.snr_db, "dB", json(), "Signal to noise.");
  add_receiver(link, fall);
  fall.total("SINR", link.sinr_db, "dB", threshold_of(subject),
             "Signal in the guard window to noise and own echoes, mean over fading, against that at which "
             "half of the packets "
             "survive without fading.");
  return fall.take();
}

json guard_json(const link_t& link, const clients::VehicleRecord& to) {
  if (!to.modem || link.num_paths == 0) return nullptr;
  // A receiver of the strongest path collects what its band cannot part from it.
  const bool resolves = to.modem->receiver_kind == modem_config_t::RECEIVER_STRONGEST_PATH;
  const double guard_s = resolves ? 1 / to.modem->bandwidth_hz : to.modem->guard_time_s;
  const double taper_s = resolves || to.modem->guard_taper_s < 0 ? guard_s : to.modem->guard_taper_s;
  return {{"begin_s", link.first_path_delay_s},
          {"end_s", link.first_path_delay_s + guard_s},
          {"taper_s", taper_s}};
}

json fading_json(const clients::RunTimeline& timeline, PacketIndex& packets, const LinkSubject& link) {
  constexpr SimDuration kRecord = SimDuration::from_milliseconds(600'000);
  constexpr std::size_t kMaxPoints = 600;
  const SimTime since = link.at - kRecord;
  json time_s = json::array(), value = json::array(), met = json::array();
  const clients::LinkColumn* column = clients::link_column("sinr_db");
  for (const auto& [at, number] :
       timeline.links().history(link.from.id, link.to.id, *column, since, link.at, kMaxPoints)) {
    const link_t* row = timeline.links().row_at(link.from.id, link.to.id, at);
    time_s.push_back(at.seconds());
    value.push_back(row != nullptr && row->path_state == link_t::PATH_OPEN ? json(number) : json());
  }
  packets.refresh(timeline.packets());
  for (const clients::PacketRecord* packet : packets.departing(timeline.packets(), since, link.at)) {
    for (const packet_outcome_t& outcome : packet->outcomes) {
      if (outcome.source_id != link.from.id || outcome.receiver_id != link.to.id) continue;
      const bool has_sinr = outcome.acquisition_probability > 0 || outcome.success_probability > 0;
      met.push_back({{"key", packet_key(*packet)},
                     {"time_s", packet->at().seconds()},
                     {"value", has_sinr ? json(outcome.sinr_db) : json()},
                     {"code", static_cast<int>(outcome.outcome)}});
    }
  }
  return {{"label", "SINR"},
          {"unit", "dB"},
          {"limit", threshold_of(link)},
          {"expected", {{"time_s", std::move(time_s)}, {"value", std::move(value)}}},
          {"packets", std::move(met)}};
}

std::string notice_of(const link_answer_t& answer) {
  if (answer.answer_status != link_answer_t::ANSWERED)
    return "The channel server has no answer: " + answer.problem + ".";
  switch (answer.link.path_state) {
    case link_t::PATH_SHADOW:
      return "No sound arrives: the water bends every ray away.";
    case link_t::PATH_BLOCKED:
      return "No sound arrives: the terrain stands between.";
    case link_t::PATH_TOO_WEAK:
      return "No sound arrives: the bounces leave too little of every ray.";
    case link_t::PATH_TOO_STEEP:
      return "No sound arrives: every ray is launched more steeply than is searched.";
    case link_t::PATH_NO_TERRAIN:
      return "No terrain: it ends or has no data on the way (beyond = \"none\").";
    default:
      break;
  }
  switch (answer.link.propagation_used) {
    case link_t::USED_STRAIGHT_WITHOUT_BOTTOM:
      return "The bathymetry service does not answer: straight paths, no seabed.";
    case link_t::USED_RAYS_BEYOND_TERRAIN:
      return "The link leaves the known terrain: its last known depth is held.";
    default:
      return "";
  }
}

}  // namespace

std::optional<link_query_t> link_query(const LinkSubject& link) {
  const auto from = state_at(link.from.track, link.at), to = state_at(link.to.track, link.at);
  if (!from || !to) return std::nullopt;
  link_query_t query{};
  query.utime = link.at.to_utime();
  query.wants_paths = 1;
  query.num_links = 1;
  query.transmitters = {end_of(link.from, from->point.position_ned_m)};
  query.receivers = {end_of(link.to, to->point.position_ned_m)};
  return query;
}

void use_positions(const clients::RunTimeline& timeline, link_query_t& query) {
  for (auto* ends : {&query.transmitters, &query.receivers}) {
    for (link_end_t& end : *ends) {
      const clients::VehicleRecord* vehicle = timeline.find(end.vehicle_name);
      end.vehicle_name.clear();
      if (vehicle == nullptr || !vehicle->modem) continue;
      end.modem_choice = link_end_t::MODEM_GIVEN;
      end.modem = *vehicle->modem;
    }
  }
}

json link_view_json(const clients::RunTimeline& timeline, PacketIndex& packets, const LinkSubject& link,
                    const link_reply_t* reply, const std::string& problem) {
  const auto from = state_at(link.from.track, link.at), to = state_at(link.to.track, link.at);
  json view = {{"from", link.from.index},
               {"to", link.to.index},
               {"time_s", link.at.seconds()},
               {"notice", nullptr},
               {"range_m", nullptr},
               {"from_depth_m", nullptr},
               {"to_depth_m", nullptr},
               {"seabed", nullptr},
               {"profile", nullptr},
               {"paths", json::array()},
               {"guard", nullptr},
               {"budget", json::array()},
               {"fading", fading_json(timeline, packets, link)}};
  if (from && to) {
    const Vec3 way = to->point.position_ned_m - from->point.position_ned_m;
    view["range_m"] = elementary::hypot(way.x(), way.y());
    view["from_depth_m"] = from->point.position_ned_m.z();
    view["to_depth_m"] = to->point.position_ned_m.z();
  }
  if (reply == nullptr || reply->answers.empty()) {
    view["notice"] = problem;
    return view;
  }
  const link_answer_t& answer = reply->answers.front();
  const link_paths_t& paths = reply->link_paths;
  const double surface_m = timeline.scenario().sea_surface_z_m;
  if (const std::string notice = notice_of(answer); !notice.empty()) view["notice"] = notice;
  if (answer.answer_status != link_answer_t::ANSWERED) return view;
  if (paths.num_seabed > 0)
    view["seabed"] = {{"range_m", rounded(paths.seabed_range_m, 0)},
                      {"depth_m", rounded(paths.seabed_depth_m, surface_m)}};
  if (paths.num_water > 0)
    view["profile"] = {{"depth_m", rounded(paths.water_depth_m, surface_m)},
                       {"sound_speed_mps", rounded(paths.water_sound_speed_mps, 0)}};
  view["paths"] = paths_json(paths, surface_m);
  if (answer.link.path_state == link_t::PATH_OPEN) {
    view["guard"] = guard_json(answer.link, link.to);
    view["budget"] = budget_json(link, answer.link, paths);
  }
  return view;
}

}  // namespace halocline::monitor
