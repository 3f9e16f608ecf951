// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/link_output.h"

#include <array>

#include <nlohmann/json.hpp>

#include "acoustics/link/link_budget.h"
#include "channel_server/links/link_predictor.h"
#include "channel_server/links/link_table.h"
#include "channel_server/propagation/propagation.h"
#include "core/frames.h"

namespace halocline::clients {

std::string_view name_of(channel_server::Multipath multipath) {
  switch (multipath) {
    case channel_server::Multipath::kUnlikely:
      return "unlikely";
    case channel_server::Multipath::kLikely:
      return "likely";
    case channel_server::Multipath::kUnknown:
      break;
  }
  return "unknown";
}

std::string_view name_of(channel_server::PathState state) {
  constexpr std::array kNames{"open", "shadow", "blocked", "too weak", "too steep", "no terrain"};
  return kNames.at(static_cast<std::size_t>(state));
}

std::string_view name_of(channel_server::PropagationUsed used) {
  constexpr std::array kNames{"straight", "rays", "straight (bottom unknown)", "straight (not searched)",
                              "rays (beyond the terrain)"};
  return kNames.at(static_cast<std::size_t>(used));
}

std::string_view name_of(acoustics::LossReason reason) {
  constexpr std::array kNames{"none", "noise", "late echoes", "fast fading", "other packets", "impulses"};
  return kNames.at(static_cast<std::size_t>(reason));
}

namespace {

nlohmann::ordered_json to_json(const LinkSurveyEnd& end) {
  const Vec3& p = end.position_ned_m;
  return {{"name", end.name}, {"position_ned_m", {p.x(), p.y(), p.z()}}};
}

}  // namespace

std::string to_json(const LinkSurveyEnd& from, const LinkSurveyEnd& to, const LinkSurvey& answer) {
  const acoustics::LinkBudget& b = answer.reception.budget;
  nlohmann::ordered_json json;
  json["from"] = to_json(from);
  json["to"] = to_json(to);
  json["range_m"] = b.range_m;
  json["delay_s"] = b.delay_s;
  json["mean_sound_speed_mps"] = b.mean_sound_speed_mps;
  json["absorption_db_per_km"] = b.absorption_db_per_km;
  json["transmission_loss_db"] = b.transmission_loss.value;
  json["received_level_db"] = b.received_level.value;
  json["noise_level_db"] = b.noise_level.value;
  if (!answer.noise_place.empty()) json["noise_place"] = answer.noise_place;
  json["snr_db"] = b.snr.value;
  json["snr_narrowband_db"] = b.snr_narrowband.value;
  json["capacity_bps"] = b.capacity_bps;
  json["receivable"] = b.receivable;
  json["multipath"] = name_of(answer.multipath);
  json["path_state"] = name_of(answer.reception.state);
  json["propagation"] = name_of(answer.reception.used);
  json["num_paths"] = channel_server::number_of_paths(answer.reception.paths);
  json["diffuse_level_db"] = answer.reception.diffuse_level.value;
  json["delay_spread_s"] = answer.reception.delay_spread_s;
  const channel_server::LinkForecast& f = answer.forecast;
  json["first_path_delay_s"] = f.first_path_delay_s;
  json["sinr_db"] = f.sinr_db;
  json["noise_db"] = channel_server::level_of(f.powers.noise).value;
  json["late_echo_db"] = channel_server::level_of(f.powers.late_echoes).value;
  json["fast_fading_db"] = channel_server::level_of(f.powers.fast_fading).value;
  json["interference_db"] = channel_server::level_of(f.powers.others).value;
  json["impulse_db"] = channel_server::level_of(f.powers.impulses).value;
  json["loss_reason"] = name_of(f.reason);
  json["acquisition_probability"] = f.acquisition_probability;
  json["delivery_probability"] = f.delivery_probability;
  json["delivery_low"] = f.delivery_low;
  json["delivery_high"] = f.delivery_high;
  json["coherence_time_s"] = f.coherence_time_s;
  json["doppler_spread_hz"] = f.doppler_spread_hz;
  json["rms_delay_spread_s"] = f.rms_delay_spread_s;
  json["best_rate_bps"] = f.best_rate_bps;
  return json.dump(2);
}

}  // namespace halocline::clients
