#include "vehicle_sim/vehicle_sim_node.h"

#include <algorithm>
#include <cstdio>

#include "vehicle_sim/vehicle_sim_messages.h"

namespace halocline::vehicle_sim {
namespace {

// A process that was not run for this long (steady time) counts what lies further back than this (simulation time)
// as late, and does not publish it: nobody waits for it any more, and the bus would lose the burst.
constexpr SimDuration kLongestHalt = SimDuration::from_milliseconds(2000);
constexpr SimDuration kLongestArrear = SimDuration::from_milliseconds(2000);
constexpr std::size_t kMostBeams = 4096;  // a message, by the service's contract

SimTime first_on_grid(SimTime from, SimDuration period) {
  return next_on_grid(from - SimDuration::from_nanoseconds(1), period);
}

SimTime last_on_grid(SimTime until, SimDuration period) { return next_on_grid(until, period) - period; }

// Unlike any earlier life's, so that the recorded answers of one are not taken for this one's.
std::string client_name(const bus::NodeIdentity& identity) {
  char session[17];
  std::snprintf(session, sizeof session, "%016llx", static_cast<unsigned long long>(identity.session));
  return identity.name.substr(0, 7) + "-" + session;
}

}  // namespace

VehicleSimNode::VehicleSimNode(lcm::LCM& lcm, bus::NodeIdentity identity, const bus::Scenario& scenario,
                               const VehicleSimConfig& config, std::shared_ptr<const Seabed> seabed)
    : Node(lcm, std::move(identity)),
      config_(config),
      settings_(settings_of(scenario, config)),
      members_(members_of(scenario, config)),
      seabed_(std::move(seabed)),
      ray_client_(client_name(bus().identity())),
      state_sequence_(members_.size()),
      sensors_sequence_(members_.size()),
      reported_lost_(members_.size()) {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    ids_.push_back(scenario.find(members_[i].name)->id);
    bus().subscribe<vehicle_command_t>(bus::channels::kCommand.of(members_[i].name),
                                       [this, i](const vehicle_command_t& m) { on_command(i, m); });
  }
  bus().subscribe<current_change_t>(bus::channels::kSetCurrent,
                                    [this](const current_change_t& m) { on_current(m); });
  bus().subscribe<ray_reply_t>(bus::channels::kRayReply.of(ray_client_),
                               [this](const ray_reply_t& reply) { on_ray_reply(reply); });
}

bus::Due VehicleSimNode::on_due() const {
  if (desk_.has_complete()) return {.sim = SimTime::at_once()};
  return {.sim = std::min(next_state_, next_sensors_), .steady = desk_.next_deadline()};
}

void VehicleSimNode::begin(SimTime now) {
  const SimTime start = last_on_grid(now, settings_.step);
  fleet_.emplace(settings_, members_, seabed_, start);
  next_state_ = first_on_grid(start, config_.state_period);
  next_sensors_ = first_on_grid(start, config_.sensor_period);
  std::fill(reported_lost_.begin(), reported_lost_.end(), false);
}

void VehicleSimNode::on_restart(const bus::Now&) {
  fleet_.reset();
  desk_.clear();
}

void VehicleSimNode::on_step(const bus::Now& now) {
  if (now.sim_known) {
    if (!fleet_) begin(now.sim);
    const bool was_halted = now.steady - last_step_ > kLongestHalt;
    for (SimTime next = std::min(next_state_, next_sensors_); next <= now.sim;
         next = std::min(next_state_, next_sensors_)) {
      fleet_->advance(next);
      const bool too_late = was_halted && now.sim - next > kLongestArrear;
      if (too_late) ++bus().counters().late;
      const bool state_due = next_state_ == next, sensors_due = next_sensors_ == next;
      if (state_due) next_state_ = next_on_grid(next, config_.state_period);
      if (sensors_due) next_sensors_ = next_on_grid(next, config_.sensor_period);
      if (state_due && !too_late) publish_states(next);
      if (sensors_due && !too_late) measure_all(next, now.steady);
    }
    report_lost();
  }
  last_step_ = now.steady;
  publish_sensors(now.steady);
}

void VehicleSimNode::publish_states(SimTime when) {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (fleet_->is_lost(i)) continue;  // what does not move as it should has no state to tell
    vehicle_state_t message = to_state_message(when, ids_[i], to_kinematic_state(fleet_->state_at(i, when)));
    message.session = bus().identity().session;
    message.sequence = state_sequence_[i]++;
    bus().publish(bus::channels::kState.of(members_[i].name), message);
  }
}

// Takes the readings and asks for the altitudes, in messages of as many beams as the service takes.
void VehicleSimNode::measure_all(SimTime when, SimTime steady) {
  SensorTick tick{when, {}, {}};
  std::vector<AltimeterBeam> beams;
  const auto ask = [&] {
    if (beams.empty()) return;
    const std::int64_t request = ray_request_++;
    desk_.wait(request, std::move(tick), steady + config_.altimeter_patience);
    bus().publish(bus::channels::kRayQuery,
                  to_ray_query(when, ray_client_, request, beams, config_.altimeter_range_m));
    tick = {when, {}, {}};
    beams.clear();
  };
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (fleet_->is_lost(i)) continue;
    const VehicleState state = fleet_->state_at(i, when);
    tick.vehicles.push_back(i);
    tick.readings.push_back(fleet_->reading_at(i, when));
    beams.push_back({state.position_ned_m, altimeter_direction(state)});
    if (beams.size() == kMostBeams) ask();
  }
  ask();
}

void VehicleSimNode::publish_sensors(SimTime steady) {
  while (const auto tick = desk_.take(steady)) {
    for (std::size_t k = 0; k < tick->vehicles.size(); ++k) {
      const std::size_t i = tick->vehicles[k];
      vehicle_sensors_t message = to_sensors_message(tick->when, tick->readings[k]);
      message.session = bus().identity().session;
      message.sequence = sensors_sequence_[i]++;
      bus().publish(bus::channels::kSensors.of(members_[i].name), message);
    }
  }
}

void VehicleSimNode::on_command(std::size_t vehicle, const vehicle_command_t& message) {
  if (!fleet_) return;  // no time, no vehicle yet; a pilot repeats itself
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

void VehicleSimNode::on_current(const current_change_t& message) {
  if (!fleet_) return;
  if (!fleet_->change_current(SimTime::from_utime(message.utime), from_message(message)))
    bus().refuse(std::string(bus::channels::kSetCurrent), "too many currents wait for their time");
}

void VehicleSimNode::on_ray_reply(const ray_reply_t& reply) {
  SensorTick* tick = desk_.answer(reply.request_id);
  if (tick == nullptr) {
    ++bus().counters().late;
    return;
  }
  const std::vector<Altitude> altitudes = altitudes_from(reply, tick->readings.size());
  for (std::size_t k = 0; k < altitudes.size(); ++k) {
    tick->readings[k].altitude_status = altitudes[k].status;
    tick->readings[k].altitude_m = altitudes[k].altitude_m;
  }
}

void VehicleSimNode::report_lost() {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (reported_lost_[i] || !fleet_->is_lost(i)) continue;
    reported_lost_[i] = true;
    bus().log().error("vehicle-lost",
                      "vehicle=" + members_[i].name + " reason=\"its equations gave no number\"");
  }
}

std::string VehicleSimNode::status_text() const {
  std::size_t aground = 0, lost = 0;
  for (std::size_t i = 0; fleet_ && i < members_.size(); ++i) {
    aground += fleet_->on_seabed(i);
    lost += fleet_->is_lost(i);
  }
  return std::to_string(members_.size()) + " vehicles, " + std::to_string(aground) + " on the seabed, " +
         std::to_string(lost) + " lost; altitudes given up: " + std::to_string(desk_.given_up());
}

}  // namespace halocline::vehicle_sim
