// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/sensor_station.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/check.h"

namespace halocline::vehicle_sim {
namespace {

SimTime first_at_or_after(SimTime start, SimDuration period) {
  if (period <= SimDuration()) return SimTime::never();
  return next_on_grid(start - SimDuration::from_nanoseconds(1), period);
}

// Returns true when the sensor is due at `when`, and sets `next` to a period later.
bool is_due(SimTime& next, SimTime when, SimDuration period) {
  if (next > when) return false;
  next = next_on_grid(when, period);
  return true;
}

template <class Beams>
std::vector<EchoBeam> list_of(const Beams& beams) {
  return {beams.begin(), beams.end()};
}

}  // namespace

SensorStation::SensorStation(std::vector<Vehicle> vehicles, std::uint64_t seed, SimDuration period,
                             double altimeter_range_m)
    : vehicles_(std::move(vehicles)), seed_(seed), period_(period), altimeter_range_m_(altimeter_range_m) {
  require(period > SimDuration(), "the period of sensors is above 0");
  begin(SimTime());
}

void SensorStation::begin(SimTime start) {
  suites_.clear();
  dvl_walks_.clear();
  times_.clear();
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    const SensorSettings& s = vehicles_[i].settings;
    suites_.emplace_back(s, seed_, vehicles_[i].id, period_);
    dvl_walks_.emplace_back(identity(i, SensorKind::kDvl), 0);
    times_.push_back({first_at_or_after(start, s.dvl.period), first_at_or_after(start, s.gps.period),
                      first_at_or_after(start, s.sonar.period)});
  }
  next_all_ = first_at_or_after(start, period_);
  find_next();
}

void SensorStation::archive(Archive& a) {
  for (SensorSuite& suite : suites_) suite.archive(a);
  a(times_, next_all_, next_);
}

void SensorStation::find_next() {
  next_ = next_all_;
  for (const Times& t : times_) next_ = std::min({next_, t.dvl, t.gps, t.sonar});
}

std::vector<SensorTick> SensorStation::take(const Fleet& fleet, std::size_t max_beams) {
  const SimTime when = next_;
  const bool all_due = is_due(next_all_, when, period_);
  std::vector<Job> without_echoes, jobs;
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    if (!all_due && std::min({times_[i].dvl, times_[i].gps, times_[i].sonar}) > when) continue;
    std::vector<Job> own;
    measure(fleet, i, all_due, own);
    const bool waits =
        std::any_of(own.begin(), own.end(), [](const Job& job) { return !job.second.empty(); });
    std::vector<Job>& all = waits ? jobs : without_echoes;
    std::move(own.begin(), own.end(), std::back_inserter(all));
  }
  find_next();
  std::vector<SensorTick> ticks;
  if (!without_echoes.empty()) ticks.push_back({when, {}, {}, {}});
  for (auto& [job, beams] : without_echoes) ticks.back().jobs.push_back(std::move(job));
  const std::size_t first = ticks.size();
  for (auto& [job, beams] : jobs) {
    if (ticks.size() == first || ticks.back().beams.size() + beams.size() > max_beams)
      ticks.push_back({when, {}, {}, {}});
    SensorTick& tick = ticks.back();
    job.first_beam = tick.beams.size();
    job.beams = beams.size();
    tick.beams.insert(tick.beams.end(), beams.begin(), beams.end());
    tick.jobs.push_back(std::move(job));
  }
  for (SensorTick& tick : ticks) tick.echoes.resize(tick.beams.size());
  return ticks;
}

void SensorStation::measure(const Fleet& fleet, std::size_t i, bool all_due, std::vector<Job>& jobs) {
  const SimTime when = next_;
  const SensorSettings& s = vehicles_[i].settings;
  Times& t = times_[i];
  const bool dvl_due = is_due(t.dvl, when, s.dvl.period), gps_due = is_due(t.gps, when, s.gps.period),
             sonar_due = is_due(t.sonar, when, s.sonar.period);
  if (fleet.has_diverged(i)) return;
  const SensorSuite::Dead dead = fleet.faults(i).dead_sensors();
  const auto works = [&](SensorKind kind) { return !dead[static_cast<std::size_t>(kind)]; };
  const VehicleState state = fleet.state_at(i, when);
  if (all_due) {
    const SensorReading reading = suites_[i].read(fleet.reading_at(i, when), when, dead);
    std::vector<EchoBeam> beams;
    if (suites_[i].altimeter_fires())
      beams.push_back({state.position_ned_m, altimeter_direction(state), altimeter_range_m_});
    jobs.emplace_back(SensorJob{i, reading}, std::move(beams));
  }
  if (gps_due && works(SensorKind::kGps) &&
      gps_sees_sky(s.gps, state, fleet.sea_surface_z_m(i, state.position_ned_m, when))) {
    const SensorIdentity gps = identity(i, SensorKind::kGps);
    const std::int64_t sample = sample_at(when, s.gps.period);
    if (!drops_out(gps, sample, s.gps.errors.dropout))
      jobs.push_back({{i, GpsFix{read_gps(s.gps, gps, sample, state)}}, {}});
  }
  if (dvl_due && works(SensorKind::kDvl))
    jobs.push_back({{i, DvlPing{state}}, list_of(dvl_beams(s.dvl, state))});
  if (sonar_due && works(SensorKind::kSonar))
    jobs.push_back({{i, SonarPing{state}}, sonar_beams(s.sonar, state)});
}

SensorReading SensorStation::finish(const SensorTick& tick, const SensorJob& job,
                                    const SensorReading& noted) {
  SensorReading reading = noted;
  if (job.beams > 0) reading.altitude = suites_[job.vehicle].read_altitude(tick.echoes_of(job)[0], tick.when);
  return reading;
}

DvlReading SensorStation::finish(const SensorTick& tick, const SensorJob& job, const DvlPing& ping) {
  const DvlSettings& dvl = vehicles_[job.vehicle].settings.dvl;
  const double walk = dvl.errors.walk > 0 ? dvl.errors.walk * dvl_walks_[job.vehicle].at(tick.when) : 0;
  return read_dvl(dvl, identity(job.vehicle, SensorKind::kDvl), sample_at(tick.when, dvl.period), ping.state,
                  tick.echoes_of(job), walk);
}

std::vector<Echo> SensorStation::finish(const SensorTick& tick, const SensorJob& job,
                                        const SonarPing&) const {
  const SonarSettings& sonar = vehicles_[job.vehicle].settings.sonar;
  return read_sonar(sonar, identity(job.vehicle, SensorKind::kSonar), sample_at(tick.when, sonar.period),
                    tick.echoes_of(job));
}

}  // namespace halocline::vehicle_sim
