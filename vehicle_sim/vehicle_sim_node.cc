// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/vehicle_sim_node.h"

#include <algorithm>
#include <functional>
#include <variant>

#include "bus/transport/subscription.h"
#include "core/check.h"
#include "core/frames.h"
#include "core/text/hex_digits.h"
#include "vehicle_sim/dynamics/command_schedule.h"
#include "vehicle_sim/sensors/sensor_errors.h"
#include "vehicle_sim/sensors/sensor_settings.h"
#include "vehicle_sim/sensors/sensors.h"
#include "vehicle_sim/vehicle_sim_messages.h"

namespace halocline::vehicle_sim {
namespace {

// Limits of late publication. When the process was halted for longer than kLongestHalt (steady time),
// messages for instants more than kLongestArrear back (simulation time) count as late and are not published:
// they are out of date, and the bus would lose the burst.
constexpr SimDuration kLongestHalt = SimDuration::from_milliseconds(2000);
constexpr SimDuration kLongestArrear = SimDuration::from_milliseconds(2000);
constexpr SimDuration kBatteryPeriod = SimDuration::from_milliseconds(1000);
constexpr SimDuration kEchoTimeout = SimDuration::from_milliseconds(250);  // for the bathymetry service
constexpr std::size_t kMaxBeams = 4096;  // maximum of one message, by the service's interface

SimTime first_on_grid(SimTime from, SimDuration period) {
  return next_on_grid(from - SimDuration::from_nanoseconds(1), period);
}

SimTime last_on_grid(SimTime until, SimDuration period) { return next_on_grid(until, period) - period; }

// The name contains the session, so that recorded replies to another run are not mistaken for its own.
std::string client_name(const bus::NodeIdentity& identity) {
  return identity.name.substr(0, 7) + "-" + hex_digits(static_cast<std::uint64_t>(identity.session));
}

}  // namespace

VehicleSimNode::VehicleSimNode(lcm::LCM& lcm, bus::NodeIdentity identity, const bus::Scenario& scenario,
                               const VehicleSimConfig& config, std::shared_ptr<const Seabed> seabed)
    : Node(lcm, std::move(identity)),
      config_(config),
      settings_(settings_of(scenario, config)),
      members_(members_of(scenario, config)),
      scenario_faults_(faults_of(members_, config)),
      seabed_(std::move(seabed)),
      ray_client_(client_name(bus().identity())),
      pool_(config.threads),
      station_(stations_of(scenario, members_, config), scenario.seed, config.sensor_period,
               config.altimeter_range_m),
      reported_diverged_(members_.size()) {
  std::stable_sort(scenario_faults_.begin(), scenario_faults_.end(),
                   [](const auto& a, const auto& b) { return a.second.from < b.second.from; });
  for (std::size_t i = 0; i < members_.size(); ++i) {
    ids_.push_back(scenario.find(members_[i].name)->id);
    subscribe_vehicle(i);
    if (station_.settings(i).usbl.fitted)
      arrays_.emplace(
          i, UsblFixAssembler(station_.settings(i).usbl, {scenario.seed, ids_[i], SensorKind::kUsbl}));
  }
  if (!arrays_.empty()) subscribe_arrays();
  bus().subscribe<current_change_t>(
      bus::channels::kSetCurrent, [this](const current_change_t& m) { on_current(m); },
      bus::Wakeup::kStoreOnly);
  bus().subscribe<ray_reply_t>(bus::channels::kRayReply.of(ray_client_),
                               [this](const ray_reply_t& reply) { on_ray_reply(reply); });
}

void VehicleSimNode::subscribe_vehicle(std::size_t i) {
  bus().subscribe<vehicle_command_t>(
      bus::channels::kCommand.of(members_[i].name),
      [this, i](const vehicle_command_t& m) { on_command(i, m); }, bus::Wakeup::kStoreOnly);
  bus().subscribe<vehicle_fault_t>(bus::channels::kFault.of(members_[i].name),
                                   [this, i](const vehicle_fault_t& m) { on_fault(i, m); });
  if (!members_[i].battery) return;
  next_battery_ = SimTime();
  bus().subscribe<modem_energy_t>(
      bus::channels::kModemEnergy.of(members_[i].name),
      [this, i](const modem_energy_t& m) {
        if (!fleet_) return;
        fleet_->spend_on_packet(i, SimTime::from_utime(m.utime), static_cast<PacketEnergy>(m.energy_cause),
                                m.energy_j);
      },
      bus::Wakeup::kStoreOnly);
}

// OUTCOME has the true direction of an arrival; the fix is the vehicle's own measurement of it.
void VehicleSimNode::subscribe_arrays() {
  bus().subscribe<packet_outcome_t>(bus::channels::kOutcome, [this](const packet_outcome_t& outcome) {
    if (outcome.outcome != packet_outcome_t::RECEIVED) return;
    for (auto& [vehicle, array] : arrays_) {
      if (ids_[vehicle] == outcome.receiver_id) array.on_arrival(key_of(outcome), arrival_of(outcome));
    }
  });
  for (auto& [vehicle, array] : arrays_) {
    bus().subscribe<modem_receive_t>(bus::channels::kReceive.of(members_[vehicle].name),
                                     [&array = array](const modem_receive_t& packet) {
                                       array.on_packet(key_of(packet), travel_time_of(packet));
                                     });
  }
}

bus::Due VehicleSimNode::on_due() const {
  if (echoes_.has_complete()) return {.sim = SimTime::at_once()};
  return {.sim = std::min(next_sample(), next_fault()), .steady = echoes_.next_deadline()};
}

void VehicleSimNode::make_fleet(SimTime start) {
  fleet_.emplace(settings_, members_, seabed_, start,
                 [this](std::size_t count, const std::function<void(std::size_t)>& body) {
                   pool_.for_each(count, body);
                 });
}

void VehicleSimNode::begin(SimTime now) {
  const SimTime start = last_on_grid(now, settings_.step);
  make_fleet(start);
  for (const auto& [vehicle, fault] : scenario_faults_)
    require(fleet_->apply_fault(vehicle, fault), "a scenario has at most 100000 faults");
  faults_published_ = 0;
  next_state_ = first_on_grid(start, config_.state_period);
  published_.assign(members_.size(), {});
  if (next_battery_ != SimTime::never()) next_battery_ = first_on_grid(start, kBatteryPeriod);
  station_.begin(start);
  std::fill(reported_diverged_.begin(), reported_diverged_.end(), false);
}

// Measurements that wait for their echoes are not archived.
void VehicleSimNode::on_archive(Archive& a) {
  bool has_begun = fleet_.has_value();
  a(has_begun, publisher_, ray_request_);
  if (!has_begun) return;
  if (a.is_loading()) {
    make_fleet(SimTime());
    last_step_ = SimTime() - kLongestHalt * 2;  // makes the next step the first after a halt
  }
  a(*fleet_, station_, next_state_, next_battery_, published_, faults_published_);
  for (auto& [vehicle, array] : arrays_) a(array);
}

void VehicleSimNode::on_restart(const bus::Now&) {
  fleet_.reset();
  for (auto& [vehicle, array] : arrays_) array.clear();
  echoes_.clear();
}

void VehicleSimNode::on_step(const bus::Now& now) {
  if (now.sim_known) {
    if (!fleet_) begin(now.sim);
    const bool was_halted = now.steady - last_step_ > kLongestHalt;
    for (SimTime next = next_sample(); next <= now.sim; next = next_sample()) {
      fleet_->advance(next);
      publish_batteries(next);
      const bool too_late = was_halted && now.sim - next > kLongestArrear;
      if (too_late) ++bus().counters().late;
      note_poses(next);
      const bool state_due = next_state_ == next, sensors_due = station_.next() == next;
      if (state_due) next_state_ = next_on_grid(next, config_.state_period);
      if (state_due && !too_late) publish_states(next);
      if (sensors_due && too_late) station_.take(*fleet_, kMaxBeams);
      if (sensors_due && !too_late) measure_all(now.steady);
    }
    publish_faults(now.sim);
    publish_bearings();
    report_diverged();
  }
  last_step_ = now.steady;
  publish_measured(now.steady);
}

void VehicleSimNode::publish_states(SimTime when) {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (fleet_->has_diverged(i)) continue;  // there is no valid state
    const KinematicState state = fleet_->published_at(i, when);
    if (!published_[i].take(config_.states, config_.state_period, when, state)) continue;
    publish(bus::channels::kState, i, to_state_message(when, ids_[i], state));
  }
}

SimTime VehicleSimNode::next_sample() const {
  return std::min({next_state_, station_.next(), next_battery_});
}

// Publishes batteries when the power of a vehicle changes, and once a second.
void VehicleSimNode::publish_batteries(SimTime when) {
  for (const PowerChange& change : fleet_->take_power_changes()) {
    publish_battery(change.at, change.member);
    if (change.has_power || !fleet_->battery(change.member)->is_empty()) continue;  // a published fault
    const Fault fault{.from = change.at, .kind = FaultKind::kEmptyBattery};
    publish(bus::channels::kFault, change.member, to_fault_message(fault, /*from_scenario=*/true));
  }
  if (next_battery_ != when) return;
  next_battery_ = next_on_grid(when, kBatteryPeriod);
  for (std::size_t i = 0; i < members_.size(); ++i) publish_battery(when, i);
}

void VehicleSimNode::publish_battery(SimTime when, std::size_t i) {
  const Battery* battery = fleet_->battery(i);
  if (battery == nullptr) return;
  publish(bus::channels::kBattery, i,
          to_battery_message(when, ids_[i], *battery, fleet_->faults(i).has_power()));
}

SimTime VehicleSimNode::next_fault() const {
  const bool has_more = fleet_ && faults_published_ < scenario_faults_.size();
  return has_more ? scenario_faults_[faults_published_].second.from : SimTime::never();
}

// Publishes the scenario's faults as they become due; the fleet has them all from the start.
void VehicleSimNode::publish_faults(SimTime until) {
  for (; next_fault() <= until; ++faults_published_) {
    const auto& [vehicle, fault] = scenario_faults_[faults_published_];
    publish(bus::channels::kFault, vehicle, to_fault_message(fault, /*from_scenario=*/true));
  }
}

// Takes the measurements that are due and requests their echoes, in messages of at most kMaxBeams beams.
void VehicleSimNode::measure_all(SimTime steady) {
  for (SensorTick& tick : station_.take(*fleet_, kMaxBeams)) {
    const std::int64_t request = ray_request_++;
    std::optional<ray_query_t> query;
    if (!tick.beams.empty()) query = to_ray_query(tick.when, ray_client_, request, tick.beams);
    echoes_.wait(request, std::move(tick), steady + kEchoTimeout);
    if (query) bus().publish(bus::channels::kRayQuery, *query);
  }
}

void VehicleSimNode::note_poses(SimTime when) {
  for (auto& [vehicle, array] : arrays_) {
    if (!fleet_->has_diverged(vehicle)) array.note_pose(when, fleet_->state_at(vehicle, when).orientation);
  }
}

void VehicleSimNode::publish_bearings() {
  for (auto& [vehicle, array] : arrays_) {
    const bool is_dead = fleet_->faults(vehicle).dead_sensors()[static_cast<std::size_t>(SensorKind::kUsbl)];
    for (const UsblFix& fix : array.take(is_dead)) {
      publish(bus::channels::kUsbl, vehicle,
              to_usbl_message(fix, station_.settings(vehicle).usbl.errors.noise));
    }
  }
}

void VehicleSimNode::publish_measured(SimTime steady) {
  while (const auto tick = echoes_.take(steady)) {
    for (const SensorJob& job : tick->jobs) publish(*tick, job);
  }
}

void VehicleSimNode::publish(const SensorTick& tick, const SensorJob& job) {
  const std::size_t i = job.vehicle;
  const SensorSettings& s = station_.settings(i);
  if (const auto* reading = std::get_if<SensorReading>(&job.sample)) {
    publish(bus::channels::kSensors, i, to_sensors_message(tick.when, station_.finish(tick, job, *reading)));
  } else if (const auto* fix = std::get_if<GpsFix>(&job.sample)) {
    publish(bus::channels::kGps, i, to_gps_message(tick.when, *fix, s.gps.errors.noise));
  } else if (const auto* ping = std::get_if<DvlPing>(&job.sample)) {
    publish(bus::channels::kDvl, i,
            to_dvl_message(tick.when, station_.finish(tick, job, *ping), s.dvl.errors.noise));
  } else if (const auto* fan = std::get_if<SonarPing>(&job.sample)) {
    publish(bus::channels::kSonar, i, to_sonar_message(tick.when, s.sonar, station_.finish(tick, job, *fan)));
  }
}

void VehicleSimNode::on_command(std::size_t vehicle, const vehicle_command_t& message) {
  if (!fleet_) return;  // the simulation time is not known yet; a pilot repeats its commands
  switch (fleet_->command(vehicle, from_message(message))) {
    case CommandVerdict::kTaken:
      return;
    case CommandVerdict::kTooOld:
      ++bus().counters().late;
      return;
    case CommandVerdict::kTooMany:
      bus().refuse(bus::channels::kCommand.of(members_[vehicle].name),
                   "too many commands wait for their time");
  }
}

void VehicleSimNode::on_fault(std::size_t vehicle, const vehicle_fault_t& message) {
  if (!fleet_ || message.from_scenario) return;
  if (message.fault_kind == vehicle_fault_t::EMPTY_BATTERY && !members_[vehicle].battery)
    return bus().refuse(bus::channels::kFault.of(members_[vehicle].name), "the vehicle has no battery");
  if (!fleet_->apply_fault(vehicle, from_message(message)))
    bus().refuse(bus::channels::kFault.of(members_[vehicle].name), "too many faults wait for their time");
}

void VehicleSimNode::on_current(const current_change_t& message) {
  if (!fleet_) return;
  if (!fleet_->change_current(SimTime::from_utime(message.utime), from_message(message)))
    bus().refuse(std::string(bus::channels::kSetCurrent), "too many currents wait for their time");
}

void VehicleSimNode::on_ray_reply(const ray_reply_t& reply) {
  SensorTick* tick = echoes_.answer(reply.request_id);
  if (tick == nullptr) {
    ++bus().counters().late;
    return;
  }
  tick->echoes = echoes_from(reply, tick->beams.size());
}

void VehicleSimNode::report_diverged() {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (reported_diverged_[i] || !fleet_->has_diverged(i)) continue;
    reported_diverged_[i] = true;
    bus().log().error("vehicle-diverged",
                      "vehicle=" + members_[i].name + " reason=\"its equations gave no number\"");
  }
}

std::string VehicleSimNode::status_text() const {
  std::size_t aground = 0, lost = 0;
  for (std::size_t i = 0; fleet_ && i < members_.size(); ++i) {
    aground += fleet_->on_seabed(i);
    lost += fleet_->has_diverged(i);
  }
  return std::to_string(members_.size()) + " vehicles, " + std::to_string(aground) + " on the seabed, " +
         std::to_string(lost) + " lost; echoes expired: " + std::to_string(echoes_.expired());
}

}  // namespace halocline::vehicle_sim
