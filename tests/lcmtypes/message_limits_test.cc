// SPDX-License-Identifier: BSD-3-Clause
// Each range annotated in lcmtypes/*.lcm that a model states as well is the same in both: the model accepts
// the limit of the message and refuses what lies beyond. Where a constant of the model is the limit, the two
// are equal.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <lcm/lcm.h>

#include "acoustics/modem/beam_pattern.h"
#include "acoustics/modem/modem.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "bathymetry/tile_service.h"
#include "bus/config/config.h"
#include "bus/messages/message_field.h"
#include "bus/messages/message_fields.h"
#include "bus/repair/flow_history.h"
#include "bus/repair/flow_watch.h"
#include "channel_server/messages/link_messages.h"
#include "channel_server/messages/scenario_messages.h"
#include "channel_server/messages/world_messages.h"
#include "channel_server/packets/reception_decision.h"
#include "channel_server/propagation/link_chart.h"
#include "core/check.h"
#include "core/csv_table.h"
#include "core/sim_time.h"
#include "vehicle_sim/dynamics/currents.h"
#include "vehicle_sim/sensor_config.h"
#include "vehicle_sim/sensors/sensor_settings.h"

namespace halocline {
namespace {

using acoustics::Environment;
using acoustics::FluidBottom;
using acoustics::Modem;
using acoustics::SoundSpeedProfile;
using vehicle_sim::CurrentSettings;

// ---- limits that a model checks

using Accept = std::function<void(double)>;  // throws InvalidArgument unless the model takes the value

struct ModelledField {
  std::string_view name;
  Accept accept;
  enum { kBoth, kMax, kMin } limits = kBoth;  // those that the model shares
};

template <class Message>
MessageField field_of(std::string_view name) {
  std::optional<MessageField> found;
  const auto visit = [&](const MessageField& field, const auto&) {
    if (field.name == name) found = field;
  };
  visit_fields(visit, Message{});
  return found.value();
}

void expect_limit(double limit, double outward, const Accept& accept) {
  EXPECT_NO_THROW(accept(limit)) << limit;
  const double beyond = limit + outward * 1e-8 * std::max(1.0, std::abs(limit));  // 10 ns of a duration
  EXPECT_THROW(accept(beyond), InvalidArgument) << beyond;
}

template <class Message>
void expect_limits_of_model(const std::vector<ModelledField>& fields) {
  for (const ModelledField& modelled : fields) {
    SCOPED_TRACE(std::string(Message::getTypeName()) + "." + std::string(modelled.name));
    const auto field = field_of<Message>(modelled.name);
    if (modelled.limits != ModelledField::kMax) expect_limit(field.min, -1, modelled.accept);
    if (modelled.limits != ModelledField::kMin) expect_limit(field.max, 1, modelled.accept);
  }
}

template <class Model, class Set>
Accept validated(Model model, Set set) {
  return [model, set](double value) {
    Model changed = model;
    set(changed, value);
    validate(changed);
  };
}

Accept environment(void (*set)(Environment&, double)) { return validated(Environment(), set); }
Accept bottom(void (*set)(FluidBottom&, double)) { return validated(FluidBottom(), set); }
Accept modem(void (*set)(Modem&, double)) {
  Modem narrow;  // at any centre frequency, and with room for any preamble
  narrow.bandwidth_hz = 1;
  narrow.packet_overhead = SimDuration::from_seconds(60);
  return validated(narrow, set);
}
Accept current(void (*set)(CurrentSettings&, double)) {
  return [set](double value) {
    CurrentSettings settings;
    settings.by_depth = {{}};
    set(settings, value);
    vehicle_sim::OceanCurrent(settings, 1);
  };
}

const std::vector<ModelledField>& changeable_water() {
  static const std::vector<ModelledField> fields{
      {"wind_speed_mps", environment([](Environment& e, double value) { e.noise.wind_mps = value; })},
      {"rain_mm_per_h", environment([](Environment& e, double value) { e.noise.rain_mm_per_h = value; })},
      {"shipping_activity", environment([](Environment& e, double value) { e.noise.shipping = value; })},
      {"sea_surface_z_m", environment([](Environment& e, double value) { e.sea_surface_z_m = value; })},
      {"layer_depth_m",
       [](double value) {
         SoundSpeedProfile::from_speeds({{value, 1500}}, {10, 35});
       }},
      {"layer_temperature_degc",
       [](double value) {
         SoundSpeedProfile::from_speeds({{0, 1500}}, {value, 35});
       }},
      {"layer_salinity_psu",
       [](double value) {
         SoundSpeedProfile::from_speeds({{0, 1500}}, {10, value});
       }},
  };
  return fields;
}

void accept_sound_speed(double value) { SoundSpeedProfile::isovelocity(value, {10, 35}); }

TEST(MessageLimits, OfAnEnvironmentAreTheModels) {
  expect_limits_of_model<environment_t>(changeable_water());
  expect_limits_of_model<environment_t>({
      {"layer_sound_speed_mps", accept_sound_speed},
      {"acidity_ph", environment([](Environment& e, double value) { e.ph = value; })},
      {"spreading_exponent", environment([](Environment& e, double value) { e.spreading_exponent = value; })},
      // 0 where no bottom is known, or where the other of the two speeds holds.
      {"bottom_density_ratio", bottom([](FluidBottom& b, double value) { b.density_ratio = value; }),
       ModelledField::kMax},
      {"bottom_sound_speed_ratio", bottom([](FluidBottom& b, double value) { b.sound_speed_ratio = value; }),
       ModelledField::kMax},
      {"bottom_sound_speed_mps", bottom([](FluidBottom& b, double value) {
         b.sound_speed_ratio = 0;
         b.sound_speed_mps = value;
       }),
       ModelledField::kMax},
      {"bottom_loss_parameter", bottom([](FluidBottom& b, double value) { b.loss_parameter = value; })},
  });
}

TEST(MessageLimits, OfAChangeOfTheWaterAreTheModels) {
  expect_limits_of_model<environment_change_t>(changeable_water());
  // 0 where temperature and salinity are set.
  expect_limits_of_model<environment_change_t>(
      {{"layer_sound_speed_mps", accept_sound_speed, ModelledField::kMax}});
}

TEST(MessageLimits, OfAProfileAreTheRowsThatArePublished) {
  const auto layers_of = [](std::size_t rows) {
    Environment water;
    std::vector<acoustics::SpeedRow> speeds;
    while (speeds.size() < rows) speeds.push_back({static_cast<double>(speeds.size()), 1500});
    water.profile = SoundSpeedProfile::from_speeds(speeds, {10, 35});
    return channel_server::to_message(water, {}, SimTime(), "").num_layers;
  };
  const double max = field_of<environment_t>("num_layers").max;
  EXPECT_EQ(field_of<environment_change_t>("num_layers").max, max);
  EXPECT_EQ(layers_of(static_cast<std::size_t>(max)), max);
  EXPECT_LT(layers_of(static_cast<std::size_t>(max) + 1), max);
}

TEST(MessageLimits, OfAModemAreTheModels) {
  expect_limits_of_model<modem_config_t>({
      {"source_level_db", modem([](Modem& m, double value) { m.source_level.value = value; })},
      {"cutoff_level_db", modem([](Modem& m, double value) { m.min_receivable_level.value = value; })},
      {"center_frequency_hz", modem([](Modem& m, double value) { m.centre_frequency_hz = value; })},
      {"bandwidth_hz", modem([](Modem& m, double value) {
         m.centre_frequency_hz = field_of<modem_config_t>("center_frequency_hz").max;
         m.bandwidth_hz = std::nextafter(value, 0);  // the model's own bound is exclusive
       }),
       ModelledField::kMax},
      {"directivity_index_db", modem([](Modem& m, double value) { m.directivity_index.value = value; })},
      {"bit_rate_bps", modem([](Modem& m, double value) { m.bit_rate_bps = value; })},
      {"packet_overhead_s",
       modem([](Modem& m, double value) { m.packet_overhead = SimDuration::from_seconds(value); })},
      {"preamble_s", modem([](Modem& m, double value) { m.preamble = SimDuration::from_seconds(value); })},
      {"guard_time_s",
       modem([](Modem& m, double value) { m.guard_time = SimDuration::from_seconds(value); })},
      {"doppler_tolerance", modem([](Modem& m, double value) { m.doppler_tolerance = value; })},
      {"beam_elevation_rad",
       [](double value) {
         acoustics::BeamPattern(std::vector<acoustics::BeamRow>{{value, 0}});
       }},
      {"beam_loss_db",
       [](double value) {
         acoustics::BeamPattern(std::vector<acoustics::BeamRow>{{0, value}});
       }},
  });
}

TEST(MessageLimits, OfACurrentAreTheModels) {
  expect_limits_of_model<current_change_t>({
      {"uniform_ned_mps", current([](CurrentSettings& c, double value) { c.uniform_ned_mps.x() = value; })},
      {"north_mps", current([](CurrentSettings& c, double value) { c.by_depth[0].north_mps = value; })},
      {"east_mps", current([](CurrentSettings& c, double value) { c.by_depth[0].east_mps = value; })},
      {"tide_amplitude_mps", current([](CurrentSettings& c, double value) { c.tide.amplitude_mps = value; })},
      {"tide_period_s", current([](CurrentSettings& c, double value) { c.tide.period_s = value; })},
      // The process of which this is the deviation has no greatest one.
      {"random_deviation_mps",
       current([](CurrentSettings& c, double value) { c.random.deviation_mps = value; }),
       ModelledField::kMin},
      {"random_time_s", current([](CurrentSettings& c, double value) { c.random.time_s = value; })},
  });
}

// `section` of a sensor's settings, with its `key` at the value.
Accept sensor(const std::string& section, const std::string& key) {
  return [=](double value) {
    vehicle_sim::SensorSettings sensors;
    auto file =
        bus::ConfigFile::parse("[" + section + "]\n" + key + " = " + format_number(value), "test.toml");
    file.read([&](bus::ConfigVisitor& v) { visit(v, sensors); });
    file.check(/*whole_file=*/true);
  };
}

Accept fault(const std::string& key) {
  return [=](double value) {
    std::vector<vehicle_sim::FaultEntry> faults;
    auto file = bus::ConfigFile::parse("[[fault]]\n" + key + " = " + format_number(value), "test.toml");
    file.read([&](bus::ConfigVisitor& v) { visit_faults(v, faults); });
    file.check(/*whole_file=*/true);
  };
}

TEST(MessageLimits, OfSensorsAreThoseOfTheirSettings) {
  expect_limits_of_model<vehicle_sonar_t>({{"max_range_m", sensor("sonar", "range_m")}});
  expect_limits_of_model<vehicle_dvl_t>({{"velocity_deviation_mps", sensor("dvl", "noise_mps")}});
  expect_limits_of_model<vehicle_gps_t>({{"fix_deviation_m", sensor("gps", "noise_m")}});
}

TEST(MessageLimits, OfAFaultAreThoseOfTheScenario) {
  expect_limits_of_model<vehicle_fault_t>(
      {{"leak_rate_kg_s", fault("leak_kg_per_s")}, {"leak_volume_m3", fault("leak_volume_m3")}});
}

// ---- limits that are constants

template <class Message>
void expect_max(std::string_view name, std::size_t constant) {
  EXPECT_EQ(field_of<Message>(name).max, static_cast<double>(constant))
      << Message::getTypeName() << "." << name;
}

TEST(MessageLimits, OfCountsAndLengthsAreConstantsOfWhatTheyCount) {
  expect_max<flow_heartbeat_t>("num_flows", bus::FlowHistory::kMaxListed);
  expect_max<flow_heartbeat_t>("num_flows_kept", bus::FlowHistory::kMaxFlows);
  expect_max<repair_request_t>("num_missing", bus::FlowWatch::kMaxPerRequest);
  expect_max<lockstep_message_t>("channel_name", LCM_MAX_CHANNEL_NAME_LENGTH);
  expect_max<link_table_t>("num_peers", channel_server::kMaxPeers);
  expect_max<scenario_info_t>("num_vehicles", channel_server::kMaxVehiclesOfPart);
  expect_max<link_paths_t>("num_paths", channel_server::LinkChart::kMaxPaths);
  expect_max<terrain_tile_t>("num_posts", static_cast<std::size_t>(bathymetry::kMaxPosts));
  expect_max<packet_outcome_t>("num_colliders", channel_server::kMaxColliders);
  expect_max<modem_config_t>("num_beam_rows", acoustics::kMaxBeamRows);
  expect_max<modem_config_t>("max_payload_bytes", acoustics::kMaxPayloadBytes);
  expect_max<modem_send_t>("payload_size", acoustics::kMaxPayloadBytes);
  expect_max<modem_receive_t>("payload_size", acoustics::kMaxPayloadBytes);
}

}  // namespace
}  // namespace halocline
