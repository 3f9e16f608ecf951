// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/localiser/localiser_node.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bus/config/scenario.h"
#include "bus/transport/subscription.h"
#include "channel_server/packets/packet.h"
#include "clients/onboard/localiser/dead_reckoning.h"
#include "clients/onboard/localiser/localiser_messages.h"
#include "core/check.h"
#include "core/elementary.h"
#include "core/frames.h"

namespace halocline::clients {
namespace {

constexpr SimDuration kLag = SimDuration::from_milliseconds(100);  // longer than a message takes

// Calls `use` for each message stamped at `latest` or before, in the order of reception, and removes it.
template <class Message, class Function>
void take_until(std::deque<Message>& received, SimTime latest, Function&& use) {
  while (!received.empty() && SimTime::from_utime(received.front().utime) <= latest) {
    use(received.front());
    received.pop_front();
  }
}

// Returns the first instant of start + k period at or after `time`.
SimTime next_ping_at(const VehicleLocaliser& config, SimTime time) {
  if (config.ping_period == SimDuration()) return SimTime::never();
  if (time <= config.ping_start) return config.ping_start;
  const SimTime since_start = SimTime() + (time - config.ping_start) - SimDuration::from_nanoseconds(1);
  return config.ping_start + (next_on_grid(since_start, config.ping_period) - SimTime());
}

std::optional<StatedStart> stated_start(const VehicleLocaliser& config) {
  if (config.start_sigma_m <= 0) return std::nullopt;
  return StatedStart{config.start_ned_m.head<2>(), config.start_sigma_m};
}

}  // namespace

LocaliserNode::Vehicle::Vehicle(bus::Bus& bus, const ModemAddress& address, const VehicleLocaliser& settings,
                                std::vector<Beacon> known_beacons, SimTime own_time)
    : config(settings),
      beacons(std::move(known_beacons)),
      modem(bus, address),
      estimator(settings.rules, stated_start(settings)),
      next_ping(next_ping_at(settings, own_time)) {}

LocaliserNode::LocaliserNode(lcm::LCM& lcm, bus::NodeIdentity identity, const LocaliserConfig& config)
    : Node(lcm, std::move(identity)), period_(config.estimate_period), clocks_(bus(), config.clocks) {
  for (const VehicleLocaliser& vehicle : config.vehicles) {
    if (!vehicle.beacons.empty()) add_vehicle(config, vehicle);
  }
  if (vehicles_.empty()) return;
  bus().subscribe_newest<environment_t>(bus::channels::kEnvironment,
                                        [this](const environment_t& message) { take_environment(message); });
}

void LocaliserNode::add_vehicle(const LocaliserConfig& config, const VehicleLocaliser& settings) {
  const auto entropy = static_cast<std::uint64_t>(bus().identity().session);
  const ModemAddress address{settings.vehicle, settings.vehicle_id,
                             bus::session_of(entropy, settings.vehicle)};
  vehicles_.push_back(std::make_unique<Vehicle>(bus(), address, settings, beacons_of(config, settings),
                                                clocks_.shown(settings.vehicle_id, SimTime())));
  Vehicle* vehicle = vehicles_.back().get();
  vehicle->modem.on_receive([vehicle](const modem_receive_t& packet) { vehicle->packets.push_back(packet); });
  bus().subscribe<vehicle_sensors_t>(
      bus::channels::kSensors.of(settings.vehicle),
      [vehicle](const vehicle_sensors_t& sensors) { vehicle->sensors.push_back(sensors); },
      bus::Wakeup::kStoreOnly);
  bus().subscribe<vehicle_state_t>(
      bus::channels::kState.of(settings.vehicle),
      [vehicle](const vehicle_state_t& state) { vehicle->states.push_back(state); }, bus::Wakeup::kStoreOnly);
  if (!settings.rules.estimate_clock()) return;
  bus().subscribe<vehicle_gps_t>(
      bus::channels::kGps.of(settings.vehicle),
      [vehicle](const vehicle_gps_t& fix) { vehicle->fixes.push_back(fix); }, bus::Wakeup::kStoreOnly);
}

void LocaliserNode::take_environment(const environment_t& message) {
  try {
    water_ = Water{to_profile(message), message.sea_surface_z_m};
    environment_ = message;
  } catch (const InvalidArgument& error) {
    bus().refuse(bus::channels::kEnvironment, error.what());
  }
}

bus::Due LocaliserNode::on_due() const {
  bus::Due due;
  for (const auto& vehicle : vehicles_) {
    due.sim =
        std::min({due.sim, clocks_.due(vehicle->config.vehicle_id, vehicle->next_ping), next_estimate_});
    due.steady = std::min(due.steady, vehicle->modem.next_resend());
  }
  return due;
}

void LocaliserNode::on_step(const bus::Now& now) {
  clocks_.set_now(now.sim);
  for (const auto& vehicle : vehicles_) {
    vehicle->modem.resend(now.steady);
    if (clocks_.shown(vehicle->config.vehicle_id, now.sim) >= vehicle->next_ping) ping(*vehicle, now);
  }
  if (now.sim < next_estimate_) return;
  const SimTime instant = next_on_grid(now.sim, period_) - period_;
  for (const auto& vehicle : vehicles_) estimate(*vehicle, instant);
  next_estimate_ = instant + period_;
}

// Sends the ping that is due. When the node starts late, only the latest due ping is sent; earlier ones are
// skipped.
void LocaliserNode::ping(Vehicle& vehicle, const bus::Now& now) {
  const std::int32_t id = vehicle.config.vehicle_id;
  const SimTime own = clocks_.shown(id, now.sim);
  const SimTime next = next_ping_at(vehicle.config, own + SimDuration::from_nanoseconds(1));
  const SimTime due = clocks_.instant_of(id, next - vehicle.config.ping_period, now.sim);
  const auto index = static_cast<std::size_t>(vehicle.pings++) % vehicle.beacons.size();
  vehicle.modem.ping(now.steady, due, vehicle.beacons[index].id);
  vehicle.next_ping = next;
}

void LocaliserNode::estimate(Vehicle& vehicle, SimTime at) {
  const SimTime known = at - kLag;
  take_until(vehicle.sensors, known,
             [&](const vehicle_sensors_t& sensors) { vehicle.estimator.move(to_motion(sensors)); });
  take_until(vehicle.states, known, [&](const vehicle_state_t& state) { vehicle.truth = state; });
  take_until(vehicle.fixes, known, [&](const vehicle_gps_t& fix) {
    take_until(vehicle.packets, SimTime::from_utime(fix.utime),
               [&](const modem_receive_t& packet) { take_packet(vehicle, packet); });
    vehicle.estimator.set_clock();
  });
  take_until(vehicle.packets, known, [&](const modem_receive_t& packet) { take_packet(vehicle, packet); });
  position_estimate_t message = message_of(vehicle, at);
  message.sequence = vehicle.last.session == 0 ? 0 : vehicle.last.sequence + 1;
  bus().publish(bus::channels::kEstimate.of(vehicle.config.vehicle), message);
  report(vehicle, message);
  vehicle.last = message;
}

void LocaliserNode::take_packet(Vehicle& vehicle, const modem_receive_t& packet) {
  const auto range = range_of(vehicle, packet);
  if (!range) return;
  const RangeVerdict verdict = vehicle.estimator.take(*range);
  vehicle.used += verdict == RangeVerdict::kUsed;
  vehicle.refused += verdict == RangeVerdict::kOutlier;
  constexpr std::array kWords{"used", "outlier", "waiting", "too-old"};
  bus().log().debug("range", "vehicle=" + vehicle.config.vehicle +
                                 " beacon=" + std::to_string(packet.source_id) +
                                 " length_m=" + std::to_string(range->length_m) +
                                 " verdict=" + kWords.at(static_cast<std::size_t>(verdict)));
}

// Returns the arrival by the vehicle's clock less its estimated offset, since the vehicle's other
// measurements are stamped with simulation time.
SimTime LocaliserNode::arrival_of(const Vehicle& vehicle, const modem_receive_t& packet) {
  const SimTime shown =
      SimTime::from_utime(packet.departure_utime) + SimDuration::from_seconds(packet.travel_time_s);
  return vehicle.config.rules.estimate_clock()
             ? shown - SimDuration::from_seconds(vehicle.last.clock_offset_s)
             : shown;
}

std::optional<RangeMeasurement> LocaliserNode::range_of(const Vehicle& vehicle,
                                                        const modem_receive_t& packet) const {
  const auto beacon = std::find_if(vehicle.beacons.begin(), vehicle.beacons.end(),
                                   [&](const Beacon& b) { return b.id == packet.source_id; });
  if (beacon == vehicle.beacons.end() || !water_) return std::nullopt;
  RangeMeasurement range;
  double travel_s = 0;
  if (packet.packet_kind == modem_receive_t::PING_REPLY) {
    const auto receipt = vehicle.modem.receipt_of(packet.packet_sequence);
    if (packet.send_session != vehicle.modem.address().session || !receipt) return std::nullopt;
    travel_s = packet.two_way_travel_time_s;
    const SimTime left = SimTime::from_utime(receipt->start_utime);
    range.at = {left, left + SimDuration::from_seconds(receipt->duration_s + travel_s) +
                          channel_server::kReplyTurnaround};
  } else if (vehicle.config.use_stamps && packet.stamped) {
    travel_s = packet.travel_time_s;
    range.at = {std::min(arrival_of(vehicle, packet), SimTime::from_utime(packet.utime))};
  } else {
    return std::nullopt;
  }
  const DeadReckoning& track = vehicle.estimator.dead_reckoning();
  if (!track.covers(range.at.front())) return std::nullopt;
  range.beacon_m = beacon->position_ned_m - Vec3(0, 0, water_->sea_surface_z_m);
  const double speed_mps =
      water_->profile.mean_sound_speed_mps(range.beacon_m.z(), track.depth_m(range.at.back()));
  range.length_m = travel_s * speed_mps;
  if (range.at.size() == 1) range.per_clock_m_s = speed_mps;
  range.sigma_m = elementary::hypot(vehicle.config.timing_sigma_s * speed_mps,
                                    vehicle.config.sound_speed_sigma * range.length_m);
  return range;
}

position_estimate_t LocaliserNode::message_of(const Vehicle& vehicle, SimTime at) const {
  position_estimate_t message{};
  message.utime = at.to_utime();
  message.session = bus().identity().session;
  message.vehicle_id = vehicle.config.vehicle_id;
  message.ranges_used = vehicle.used;
  message.ranges_refused = vehicle.refused;
  const auto found = water_ ? vehicle.estimator.estimate(at) : std::nullopt;
  if (found) {
    set_estimate(message, *found, vehicle.estimator.dead_reckoning().depth_m(at) + water_->sea_surface_z_m,
                 vehicle.config.rules);
  }
  constexpr SimDuration kFresh = SimDuration::from_milliseconds(5000);
  message.truth_known = vehicle.truth && at - SimTime::from_utime(vehicle.truth->utime) <= kFresh;
  if (found && message.truth_known) {
    Eigen::Map<Vec3>(message.error_ned_m) = Vec3(message.position_ned_m) - true_position(*vehicle.truth, at);
  }
  return message;
}

void LocaliserNode::report(const Vehicle& vehicle, const position_estimate_t& message) {
  const bool news = message.estimate_status != vehicle.last.estimate_status;
  constexpr int kEvery = 10;
  if (!news && message.sequence % kEvery != 0) return;
  constexpr std::array kWords{"none", "ambiguous", "unique"};
  const double* c = message.covariance_ned_m2;
  bus().log().info(
      "position",
      "vehicle=" + vehicle.config.vehicle +
          " estimate=" + kWords.at(static_cast<std::size_t>(message.estimate_status)) + " north_m=" +
          std::to_string(message.position_ned_m[0]) + " east_m=" + std::to_string(message.position_ned_m[1]) +
          " sigma_m=" + std::to_string(std::sqrt(c[0] + c[4])) + " error_m=" +
          (message.truth_known ? std::to_string(Vec3(message.error_ned_m).head<2>().norm()) : "unknown"));
}

void LocaliserNode::on_restart(const bus::Now& now) {
  next_estimate_ = SimTime();
  water_.reset();
  environment_.reset();
  clocks_.restart(now.sim);
  for (const auto& vehicle : vehicles_) {
    vehicle->estimator = PositionEstimator(vehicle->config.rules, stated_start(vehicle->config));
    vehicle->sensors.clear();
    vehicle->states.clear();
    vehicle->packets.clear();
    vehicle->fixes.clear();
    vehicle->truth.reset();
    vehicle->used = vehicle->refused = 0;
    vehicle->next_ping = next_ping_at(vehicle->config, clocks_.shown(vehicle->config.vehicle_id, now.sim));
  }
}

void LocaliserNode::on_archive(Archive& a) {
  a(next_estimate_, environment_, clocks_);
  for (const auto& vehicle : vehicles_) a(*vehicle);
  if (a.is_loading() && environment_) take_environment(environment_t(*environment_));
}

void LocaliserNode::Vehicle::archive(Archive& a) {
  a(modem, estimator, sensors, states, packets, fixes, truth, last, pings, used, refused, next_ping);
}

std::string LocaliserNode::status_text() const {
  if (vehicles_.empty()) return "no vehicle has beacons";
  std::string text;
  for (const auto& vehicle : vehicles_) {
    const position_estimate_t& last = vehicle->last;
    const double error_m = Vec3(last.error_ned_m).head<2>().norm();
    text += (text.empty() ? "" : ", ") + vehicle->config.vehicle + ": " + std::to_string(vehicle->used) +
            " ranges, " +
            (last.estimate_status == position_estimate_t::NONE ? "no place yet"
             : last.truth_known                                ? "error " + std::to_string(error_m) + " m"
                                                               : "no truth to compare with");
  }
  return text;
}

}  // namespace halocline::clients
