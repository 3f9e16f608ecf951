// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/messages/link_messages.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "acoustics/fading/arrival.h"
#include "acoustics/rays/ray_trace.h"
#include "acoustics/reception/disturbing_powers.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "bus/messages/message_checks.h"
#include "channel_server/messages/world_messages.h"
#include "channel_server/propagation/link_chart.h"
#include "core/check.h"
#include "core/frames.h"

namespace halocline::channel_server {
namespace {

Vec3 to_vec3(const double (&values)[3]) { return {values[0], values[1], values[2]}; }

std::vector<double> as_vector(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

LinkEndRequest to_end_request(const link_end_t& message) {
  LinkEndRequest end{message.vehicle_name, to_vec3(message.position_ned_m)};
  if (message.modem_choice == link_end_t::MODEM_SCENARIO) return end;
  if (message.modem_choice != link_end_t::MODEM_GIVEN) {
    end.problem = "modem_choice is no value of its enumeration";
    return end;
  }
  end.problem = bus::problem_in(message.modem);
  if (!end.problem.empty()) return end;
  try {
    end.modem = to_modem(message.modem);
  } catch (const InvalidArgument& error) {
    end.problem = error.what();
  }
  return end;
}

arrival_t to_message(const LinkChart::Row& row) {
  const acoustics::Arrival& arrival = row.arrival;
  arrival_t message{};
  message.path_delay_s = arrival.delay_s;
  message.path_level_db = arrival.level.value;
  message.phase_rad = arrival.phase_rad;
  message.launch_angle_rad = arrival.launch_angle_rad;
  message.arrival_angle_rad = arrival.arrival_angle_rad;
  message.surface_bounces = arrival.surface_bounces;
  message.bottom_bounces = arrival.bottom_bounces;
  message.caustics = arrival.caustics;
  message.guard_weight = row.guard_weight;
  message.doppler_factor = arrival.doppler_factor;
  message.path_length_m = arrival.path_length_m;
  message.spreading_loss_db = row.spreading_db;
  message.absorption_loss_db = arrival.absorption_db;
  message.surface_loss_db = row.surface_db;
  message.bottom_loss_db = row.bottom_db;
  message.beam_loss_db = row.beam_db;
  return message;
}

link_paths_t to_message(const LinkDetails& details) {
  const LinkChart& chart = details.chart;
  link_paths_t message{};
  message.source_level_db = details.source_level.value;
  message.directivity_index_db = details.directivity_index.value;
  message.link_range_m = chart.link.range_m;
  message.source_depth_m = chart.link.source_depth_m;
  message.receiver_depth_m = chart.link.receiver_depth_m;
  message.paths_left_out = static_cast<std::int32_t>(chart.paths_left_out);
  message.num_paths = static_cast<std::int32_t>(chart.rows.size());
  for (std::size_t i = 0; i < chart.rows.size(); ++i) {
    message.paths.push_back(to_message(chart.rows[i]));
    for (const acoustics::RayPoint& point : chart.rows[i].course) {
      message.point_path.push_back(static_cast<std::int32_t>(i));
      message.point_range_m.push_back(static_cast<float>(point.range_m));
      message.point_depth_m.push_back(static_cast<float>(point.depth_m));
    }
  }
  message.num_points = static_cast<std::int32_t>(message.point_path.size());
  message.num_seabed = static_cast<std::int32_t>(chart.seabed.size());
  for (const acoustics::RayPoint& point : chart.seabed) {
    message.seabed_range_m.push_back(static_cast<float>(point.range_m));
    message.seabed_depth_m.push_back(static_cast<float>(point.depth_m));
  }
  message.num_water = static_cast<std::int32_t>(details.water.size());
  for (const acoustics::SpeedRow& row : details.water) {
    message.water_depth_m.push_back(static_cast<float>(row.depth_m));
    message.water_sound_speed_mps.push_back(static_cast<float>(row.sound_speed_mps));
  }
  return message;
}

link_answer_t to_message(const LinkAnswer& answer) {
  link_answer_t message{};
  message.answer_status = static_cast<std::int8_t>(answer.status);
  message.problem = answer.problem;
  if (answer.status != LinkAnswer::Status::kAnswered) return message;
  message.link = to_message(answer.row);
  message.getss_received_strength_db = message.link.received_level_db;
  message.getpd_propagation_delay_s = message.link.delay_s;
  message.getbw_capacity_kbps = message.link.capacity_bps / 1000;
  message.getml_multipath = message.link.multipath;
  return message;
}

}  // namespace

link_t to_message(const LinkRow& row) {
  link_t message{};
  message.transmitter_id = row.transmitter_id;
  message.receiver_id = row.receiver_id;
  message.range_m = row.budget.range_m;
  message.delay_s = row.budget.delay_s;
  message.transmission_loss_db = row.budget.transmission_loss.value;
  message.received_level_db = row.budget.received_level.value;
  message.noise_level_db = row.budget.noise_level.value;
  message.snr_db = row.budget.snr.value;
  message.capacity_bps = row.budget.capacity_bps;
  message.receivable = row.budget.receivable ? 1 : 0;
  message.multipath = static_cast<std::int8_t>(row.multipath);
  message.transmitter_age_s = row.transmitter_age.seconds();
  message.receiver_age_s = row.receiver_age.seconds();
  message.path_state = static_cast<std::int8_t>(row.state);
  message.propagation_used = static_cast<std::int8_t>(row.used);
  message.num_paths = row.path_count;
  message.diffuse_level_db = row.diffuse_level.value;
  message.paths_age_s = row.paths_age.seconds();
  message.delay_spread_s = row.delay_spread_s;
  message.first_path_doppler_factor = row.doppler_factor;
  message.first_path_delay_s = row.forecast.first_path_delay_s;
  message.sinr_db = row.forecast.sinr_db;
  const acoustics::DisturbingPowers& powers = row.forecast.powers;
  message.noise_db = level_of(powers.noise).value;
  message.late_echo_db = level_of(powers.late_echoes).value;
  message.fast_fading_db = level_of(powers.fast_fading).value;
  message.interference_db = level_of(powers.others).value;
  message.impulse_db = level_of(powers.impulses).value;
  message.loss_reason = static_cast<std::int8_t>(row.forecast.reason);
  message.acquisition_probability = row.forecast.acquisition_probability;
  message.delivery_probability = row.forecast.delivery_probability;
  message.delivery_low = row.forecast.delivery_low;
  message.delivery_high = row.forecast.delivery_high;
  message.coherence_time_s = row.forecast.coherence_time_s;
  message.doppler_spread_hz = row.forecast.doppler_spread_hz;
  message.rms_delay_spread_s = row.forecast.rms_delay_spread_s;
  message.best_rate_bps = row.forecast.best_rate_bps;
  return message;
}

std::vector<link_table_t> to_messages(const LinkTable& table, SimTime at) {
  std::vector<link_table_t> messages;
  std::size_t row = 0;
  do {
    link_table_t message{};
    message.utime = at.to_utime();
    message.vehicle_id = table.vehicle_id;
    message.reach_m = table.range_m;
    message.num_out_of_reach = static_cast<std::int32_t>(table.out_of_range);
    const std::size_t end = std::min(row + kMaxPeers, table.rows.size());
    for (; row < end; ++row) message.peers.push_back(to_message(table.rows[row]));
    message.num_peers = static_cast<std::int32_t>(message.peers.size());
    messages.push_back(std::move(message));
  } while (row < table.rows.size());
  return messages;
}

LinkQuery to_query(const link_query_t& message) {
  LinkQuery query{message.client_name, message.request_id, {}, {}, message.wants_paths != 0};
  for (const link_end_t& end : message.transmitters) query.transmitters.push_back(to_end_request(end));
  for (const link_end_t& end : message.receivers) query.receivers.push_back(to_end_request(end));
  return query;
}

link_reply_t to_message(const LinkReply& reply) {
  link_reply_t message{};
  message.utime = reply.at.to_utime();
  message.request_id = reply.request_id;
  message.reply_status = reply.refusal.empty() ? link_reply_t::OK : link_reply_t::REFUSED;
  message.refusal = reply.refusal;
  message.num_answers = static_cast<std::int32_t>(reply.answers.size());
  for (const LinkAnswer& answer : reply.answers) message.answers.push_back(to_message(answer));
  if (reply.details) message.link_paths = to_message(*reply.details);
  return message;
}

BestPlaceQuery to_query(const best_place_query_t& message) {
  BestPlaceQuery query{message.client_name,  message.request_id, {}, message.talker_name, {},
                       message.listener_name};
  if (message.utime != 0) query.at = SimTime::from_utime(message.utime);
  for (const std::vector<double>& place : message.place_ned_m)
    query.places_ned_m.emplace_back(place[0], place[1], place[2]);
  return query;
}

best_place_reply_t to_message(const BestPlaceReply& reply) {
  best_place_reply_t message{};
  message.utime = reply.at.to_utime();
  message.request_id = reply.request_id;
  message.reply_status = reply.refusal.empty() ? best_place_reply_t::OK : best_place_reply_t::REFUSED;
  message.refusal = reply.refusal;
  const auto best = best_of(reply.scores);
  message.best_place = best ? static_cast<std::int32_t>(*best) : -1;
  message.num_places = static_cast<std::int32_t>(reply.scores.size());
  for (const PlaceScore& score : reply.scores) {
    message.mean_delivery.push_back(score.mean_delivery);
    message.least_delivery.push_back(score.least_delivery);
    message.mean_sinr_db.push_back(score.mean_sinr_db);
  }
  return message;
}

ray_query_t to_message(const RayQueryBatch& batch, std::string_view client, SimTime asked_at) {
  ray_query_t message{};
  message.utime = asked_at.to_utime();
  message.client_name = client;
  message.request_id = batch.request_id;
  message.query_mode = ray_query_t::DEPTH_TILES;
  message.sample_spacing_m = batch.spacing_m;
  message.num_rays = static_cast<std::int32_t>(batch.origins_ned_m.size());
  for (const Vec3& origin_ned_m : batch.origins_ned_m) {
    message.offset_m.push_back(as_vector(origin_ned_m));
    message.direction.push_back(as_vector(Vec3::UnitZ()));
    message.max_range_m.push_back(1);  // not read: a depth belongs to a place
  }
  return message;
}

std::vector<RayAnswer> to_answers(const ray_reply_t& message) {
  std::vector<RayAnswer> answers;
  for (std::size_t i = 0; i < message.ray_status.size(); ++i) {
    answers.push_back({static_cast<RayAnswer::Kind>(message.ray_status[i]), message.result_m[i]});
  }
  return answers;
}

}  // namespace halocline::channel_server
