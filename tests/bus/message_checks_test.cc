#include "bus/message_checks.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/bus/messages_for_tests.h"

namespace halocline::bus {
namespace {

using ::testing::HasSubstr;
using testing::valid_message;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// link_end_t and link_answer_t are judged inside their query and reply.
template <class Message>
std::string problem_of(const Message& message) {
  if constexpr (std::is_same_v<Message, link_end_t> || std::is_same_v<Message, link_answer_t>) {
    return "";
  } else {
    return problem_in(message);
  }
}

template <class Message>
void expect_valid() {
  for (unsigned seed = 0; seed < 12; ++seed) {
    EXPECT_EQ(problem_of(valid_message<Message>(seed)), "") << Message::getTypeName() << " seed " << seed;
  }
}

TEST(MessageChecks, EveryValidMessagePasses) {
  std::apply([](auto... message) { (expect_valid<decltype(message)>(), ...); }, testing::AllMessages());
}

// `places` change one field each; every NaN and infinity there must be refused.
template <class Message, class... Places>
void expect_finite(Places... places) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    int number = 0;
    const auto check = [&](auto place) {
      Message message = valid_message<Message>(2);
      place(message) = bad;
      EXPECT_NE(problem_in(message), "") << Message::getTypeName() << " field " << number << " = " << bad;
      ++number;
    };
    (check(places), ...);
  }
}

#define FIELD(name) [](auto& m) -> double& { return m.name; }

TEST(MessageChecks, RefusesNanAndInfinityInEveryNumber) {
  expect_finite<sim_clock_t>(FIELD(clock_rate));
  expect_finite<vehicle_state_t>(FIELD(position_ned_m[0]), FIELD(position_ned_m[2]),
                                 FIELD(orientation_wxyz[0]), FIELD(orientation_wxyz[3]),
                                 FIELD(velocity_ned_mps[1]), FIELD(angular_velocity_body_radps[2]));
  expect_finite<vehicle_command_t>(FIELD(propeller_rpm), FIELD(rudder_rad), FIELD(stern_plane_rad),
                                   FIELD(thruster_rpm[3]));
  expect_finite<current_change_t>(FIELD(uniform_ned_mps[2]), FIELD(depth_m[1]), FIELD(north_mps[0]),
                                  FIELD(east_mps[0]), FIELD(tide_amplitude_mps), FIELD(tide_period_s),
                                  FIELD(tide_phase_rad), FIELD(tide_toward_rad), FIELD(random_deviation_mps),
                                  FIELD(random_time_s));
  expect_finite<vehicle_sensors_t>(FIELD(depth_m), FIELD(altitude_m), FIELD(water_speed_mps),
                                   FIELD(heading_rad), FIELD(pitch_rad), FIELD(roll_rad),
                                   FIELD(angular_rate_body_radps[0]), FIELD(shaft_rpm),
                                   FIELD(rudder_angle_rad), FIELD(stern_angle_rad), FIELD(thruster_rpm[0]));
  expect_finite<vehicle_dvl_t>(FIELD(beam_range_m[0]), FIELD(beam_speed_mps[3]),
                               FIELD(ground_velocity_body_mps[1]), FIELD(velocity_deviation_mps));
  expect_finite<vehicle_gps_t>(FIELD(fix_north_m), FIELD(fix_east_m), FIELD(fix_deviation_m));
  expect_finite<vehicle_sonar_t>(FIELD(fan_tilt_rad), FIELD(greatest_range_m), FIELD(fan_azimuth_rad[0]),
                                 FIELD(echo_range_m[2]));
  expect_finite<vehicle_usbl_t>(FIELD(peer_bearing_rad), FIELD(peer_elevation_rad),
                                FIELD(angle_deviation_rad), FIELD(one_way_travel_time_s));
  expect_finite<vehicle_fault_t>(FIELD(stuck_angle_rad), FIELD(leak_rate_kg_s), FIELD(leak_volume_m3));
  expect_finite<environment_t>(
      FIELD(layer_depth_m[1]), FIELD(layer_sound_speed_mps[0]), FIELD(layer_temperature_degc[0]),
      FIELD(layer_salinity_psu[0]), FIELD(wind_speed_mps), FIELD(shipping_activity), FIELD(acidity_ph),
      FIELD(sea_surface_z_m), FIELD(spreading_exponent), FIELD(bottom_density_ratio),
      FIELD(bottom_sound_speed_ratio), FIELD(bottom_sound_speed_mps), FIELD(bottom_loss_parameter));
  expect_finite<environment_change_t>(FIELD(wind_speed_mps), FIELD(shipping_activity), FIELD(sea_surface_z_m),
                                      FIELD(layer_depth_m[3]), FIELD(layer_sound_speed_mps[0]),
                                      FIELD(layer_temperature_degc[1]), FIELD(layer_salinity_psu[2]));
  expect_finite<modem_config_t>(
      FIELD(source_level_db), FIELD(center_frequency_hz), FIELD(bandwidth_hz), FIELD(directivity_index_db),
      FIELD(cutoff_level_db), FIELD(bit_rate_bps), FIELD(packet_overhead_s), FIELD(preamble_s),
      FIELD(guard_time_s), FIELD(doppler_tolerance), FIELD(beam_elevation_rad[3]), FIELD(beam_loss_db[9]));
  expect_finite<modem_receipt_t>(FIELD(duration_s));
  expect_finite<modem_receive_t>(FIELD(travel_time_s), FIELD(two_way_travel_time_s), FIELD(received_level_db),
                                 FIELD(snr_db), FIELD(doppler_factor), FIELD(sinr_db));
  expect_finite<packet_outcome_t>(
      FIELD(travel_time_s), FIELD(duration_s), FIELD(range_m), FIELD(transmission_loss_db),
      FIELD(received_level_db), FIELD(noise_level_db), FIELD(snr_db), FIELD(cutoff_level_db),
      FIELD(delay_spread_s), FIELD(doppler_factor), FIELD(interference_level_db), FIELD(sinr_db),
      FIELD(acquisition_probability), FIELD(success_probability), FIELD(acquisition_draw),
      FIELD(success_draw), FIELD(arrival_azimuth_rad), FIELD(arrival_elevation_rad));
  expect_finite<position_estimate_t>(FIELD(likelihood));
  expect_finite<link_t>(FIELD(range_m), FIELD(delay_s), FIELD(transmission_loss_db), FIELD(received_level_db),
                        FIELD(noise_level_db), FIELD(snr_db), FIELD(capacity_bps), FIELD(transmitter_age_s),
                        FIELD(receiver_age_s), FIELD(delay_spread_s), FIELD(doppler_factor));
  expect_finite<link_table_t>(FIELD(peers[3].snr_db));
  expect_finite<link_reply_t>(FIELD(answers[1].link.range_m), FIELD(answers[1].getss_received_strength_db),
                              FIELD(answers[1].getpd_propagation_delay_s),
                              FIELD(answers[1].getbw_capacity_kbps));
  expect_finite<ray_query_t>(FIELD(base_origin_ned_m[1]));
  expect_finite<ray_reply_t>(FIELD(result_m[4]), FIELD(sample_distance_m[2]), FIELD(sample_seabed_z_m[0]));
}

#undef FIELD

template <class Message, class Change>
std::string problem_after(Change change) {
  Message message = valid_message<Message>(2);
  change(message);
  return problem_in(message);
}

TEST(MessageChecks, RefusesEnumerationsWithoutAMeaning) {
  for (const int bad : {-128, -1, 11, 127}) {
    const auto value = static_cast<std::int8_t>(bad);
    EXPECT_NE(problem_after<vehicle_sensors_t>([&](auto& m) { m.altitude_status = value; }), "");
    EXPECT_NE(problem_after<vehicle_dvl_t>([&](auto& m) { m.beam_status[2] = value; }), "");
    EXPECT_NE(problem_after<vehicle_sonar_t>([&](auto& m) { m.echo_status[0] = value; }), "");
    EXPECT_NE(problem_after<vehicle_usbl_t>([&](auto& m) { m.packet_kind = value; }), "");
    EXPECT_NE(problem_after<vehicle_fault_t>([&](auto& m) { m.fault_kind = value; }), "");
    EXPECT_NE(problem_after<vehicle_fault_t>([&](auto& m) { m.dead_sensor = value; }), "");
    EXPECT_NE(problem_after<modem_config_t>([&](auto& m) { m.modem_profile = value; }), "");
    EXPECT_NE(problem_after<modem_config_t>([&](auto& m) { m.when_busy = value; }), "");
    EXPECT_NE(problem_after<modem_receipt_t>([&](auto& m) { m.receipt_result = value; }), "");
    EXPECT_NE(problem_after<packet_outcome_t>([&](auto& m) { m.packet_fate = value; }), "");
    EXPECT_NE(problem_after<packet_outcome_t>([&](auto& m) { m.packet_kind = value; }), "");
    EXPECT_NE(problem_after<packet_outcome_t>([&](auto& m) { m.propagation_used = value; }), "");
    EXPECT_NE(problem_after<packet_outcome_t>([&](auto& m) { m.colliders[0].packet_kind = value; }), "");
    EXPECT_NE(problem_after<modem_send_t>([&](auto& m) { m.packet_kind = value; }), "");
    EXPECT_NE(problem_after<modem_receive_t>([&](auto& m) { m.packet_kind = value; }), "");
    EXPECT_NE(problem_after<position_estimate_t>([&](auto& m) { m.estimate_status = value; }), "");
    EXPECT_NE(problem_after<link_t>([&](auto& m) { m.multipath = value; }), "");
    EXPECT_NE(problem_after<link_t>([&](auto& m) { m.path_state = value; }), "");
    EXPECT_NE(problem_after<link_t>([&](auto& m) { m.propagation_used = value; }), "");
    EXPECT_NE(problem_after<environment_change_t>([&](auto& m) { m.profile_set = value; }), "");
    EXPECT_NE(problem_after<link_reply_t>([&](auto& m) { m.reply_status = value; }), "");
    EXPECT_NE(problem_after<link_reply_t>([&](auto& m) { m.answers[0].answer_status = value; }), "");
    EXPECT_NE(problem_after<link_reply_t>([&](auto& m) { m.answers[0].getml_multipath = value; }), "");
    EXPECT_NE(problem_after<ray_reply_t>([&](auto& m) { m.reply_status = value; }), "");
    EXPECT_NE(problem_after<ray_reply_t>([&](auto& m) { m.ray_status[0] = value; }), "");
  }
}

TEST(MessageChecks, AModemHasOneOfElevenErrorModels) {
  for (const int bad : {-1, 11, 127}) {
    EXPECT_NE(problem_after<modem_config_t>([&](auto& m) { m.error_model = static_cast<std::int8_t>(bad); }),
              "");
  }
  for (std::int8_t good = 0; good <= 10; ++good) {
    EXPECT_EQ(problem_after<modem_config_t>([&](auto& m) { m.error_model = good; }), "");
  }
}

TEST(MessageChecks, ACurrentsDepthsRise) {
  EXPECT_THAT(problem_after<current_change_t>([](auto& m) { m.depth_m[2] = m.depth_m[1]; }),
              HasSubstr("depth_m"));
  EXPECT_THAT(problem_after<current_change_t>([](auto& m) { m.tide_period_s = 0; }),
              HasSubstr("tide_period_s"));
}

TEST(MessageChecks, AVehicleHasAnIdFromOneAndAPacketMayGoToAll) {
  EXPECT_NE(problem_after<vehicle_state_t>([](auto& m) { m.vehicle_id = 0; }), "");
  EXPECT_NE(problem_after<vehicle_state_t>([](auto& m) { m.vehicle_id = -5; }), "");
  EXPECT_NE(problem_after<modem_send_t>([](auto& m) { m.source_id = 0; }), "");
  EXPECT_NE(problem_after<modem_send_t>([](auto& m) { m.destination_id = -1; }), "");
  EXPECT_EQ(problem_after<modem_send_t>([](auto& m) {
              m.destination_id = 0;
              m.packet_kind = modem_send_t::DATA;
            }),
            "");
}

TEST(MessageChecks, APingGoesToOneVehicle) {
  EXPECT_NE(problem_after<modem_send_t>([](auto& m) {
              m.destination_id = 0;
              m.packet_kind = modem_send_t::PING;
            }),
            "");
}

TEST(MessageChecks, RefusesAClientNameThatNoChannelMayHave) {
  for (const char* name : {"", "A", "a.b", "a*", "with space", "a-name-that-is-longer-than-24", "\xff"}) {
    EXPECT_NE(problem_after<link_query_t>([&](auto& m) { m.client_name = name; }), "") << name;
    EXPECT_NE(problem_after<ray_query_t>([&](auto& m) { m.client_name = name; }), "") << name;
    EXPECT_NE(problem_after<node_status_t>([&](auto& m) { m.node_name = name; }), "") << name;
  }
}

TEST(MessageChecks, RefusesTimesThatWouldOverflow) {
  for (const std::int64_t utime :
       {std::numeric_limits<std::int64_t>::min(), std::int64_t{-4'000'000'000'000'000},
        std::int64_t{4'000'000'000'000'000}, std::numeric_limits<std::int64_t>::max()}) {
    EXPECT_NE(problem_after<vehicle_state_t>([&](auto& m) { m.utime = utime; }), "");
    EXPECT_NE(problem_after<modem_receipt_t>([&](auto& m) { m.start_utime = utime; }), "");
    EXPECT_NE(problem_after<modem_receive_t>([&](auto& m) { m.departure_utime = utime; }), "");
  }
  // Unix time in microseconds is a time: real vehicles stamp so.
  EXPECT_EQ(problem_after<vehicle_state_t>([](auto& m) { m.utime = 1'760'000'000'000'000; }), "");
}

TEST(MessageChecks, AQuaternionHasUnitLength) {
  const auto scaled = [](double factor) {
    return problem_after<vehicle_state_t>([&](auto& m) {
      for (double& q : m.orientation_wxyz) q *= factor;
    });
  };
  EXPECT_EQ(scaled(1 + 5e-4), "");  // single precision errs by 1e-7; 1e-3 is allowed
  EXPECT_THAT(scaled(0), HasSubstr("orientation"));
  EXPECT_THAT(scaled(1.01), HasSubstr("orientation"));
}

TEST(MessageChecks, DepthsOfLayersAscend) {
  EXPECT_THAT(problem_after<environment_t>([](auto& m) { m.layer_depth_m[2] = m.layer_depth_m[1]; }),
              HasSubstr("does not ascend"));
  EXPECT_NE(problem_after<environment_t>([](auto& m) {
              m.num_layers = 0;
              m.layer_depth_m.clear();
            }),
            "");
}

TEST(MessageChecks, LayersOfAChangeOfTheWaterAscendAndAreThereWhenAProfileIsSet) {
  EXPECT_THAT(problem_after<environment_change_t>([](auto& m) { m.layer_depth_m[2] = m.layer_depth_m[1]; }),
              HasSubstr("does not ascend"));
  const auto with_no_layers = [](std::int8_t profile_set) {
    return problem_after<environment_change_t>([&](auto& m) {
      m.profile_set = profile_set;
      m.num_layers = 0;
      m.layer_depth_m.clear();
    });
  };
  EXPECT_THAT(with_no_layers(environment_change_t::PROFILE_WATER), HasSubstr("num_layers"));
  EXPECT_THAT(with_no_layers(environment_change_t::PROFILE_SPEED), HasSubstr("num_layers"));
  EXPECT_EQ(with_no_layers(environment_change_t::PROFILE_UNCHANGED), "");
}

TEST(MessageChecks, AChangeOfTheWaterHasASessionBecauseNoneIsTheScenarios) {
  EXPECT_THAT(problem_after<environment_change_t>([](auto& m) { m.session = 0; }), HasSubstr("session"));
}

TEST(MessageChecks, ABeamHasUpToARowADegreeAndRises) {
  const auto with_rows = [](int count) {
    return problem_after<modem_config_t>([&](auto& m) {
      m.num_beam_rows = count;
      m.beam_loss_db.assign(static_cast<std::size_t>(count), 3);
      m.beam_elevation_rad.clear();
      for (int i = 0; i < count; ++i) m.beam_elevation_rad.push_back(-1.5 + 0.01 * i);
    });
  };
  EXPECT_EQ(with_rows(0), "");
  EXPECT_EQ(with_rows(181), "");
  EXPECT_THAT(with_rows(182), HasSubstr("num_beam_rows"));
  EXPECT_THAT(problem_after<modem_config_t>([](auto& m) { m.beam_elevation_rad[3] = -1; }),
              HasSubstr("does not rise"));
  EXPECT_THAT(problem_after<modem_config_t>([](auto& m) { m.beam_elevation_rad[9] = 1.6; }),
              HasSubstr("beam_elevation_rad"));
  EXPECT_THAT(problem_after<modem_config_t>([](auto& m) { m.beam_loss_db[0] = -61; }),
              HasSubstr("beam_loss_db"));
}

TEST(MessageChecks, NumbersOfAPacketsEndAreOnesThatCanBe) {
  const auto refuses = [](auto change) { return !problem_after<packet_outcome_t>(change).empty(); };
  EXPECT_TRUE(refuses([](auto& m) { m.acquisition_probability = 1.001; }));
  EXPECT_TRUE(refuses([](auto& m) { m.success_probability = -0.001; }));
  EXPECT_TRUE(refuses([](auto& m) { m.acquisition_draw = 2; }));
  EXPECT_TRUE(refuses([](auto& m) { m.success_draw = -1; }));
  EXPECT_TRUE(refuses([](auto& m) { m.num_paths = -1; }));
  EXPECT_TRUE(refuses([](auto& m) { m.delay_spread_s = -1e-9; }));
  EXPECT_TRUE(refuses([](auto& m) { m.doppler_factor = -1; }));
  EXPECT_TRUE(refuses([](auto& m) { m.colliders[0].source_id = 0; }));
  EXPECT_TRUE(refuses([](auto& m) {
    m.num_colliders = 17;
    m.colliders.assign(17, m.colliders[0]);
  }));
}

TEST(MessageChecks, NumbersOfALinkAreOnesThatCanBe) {
  const auto refuses = [](auto change) { return !problem_after<link_t>(change).empty(); };
  EXPECT_TRUE(refuses([](auto& m) { m.num_paths = -1; }));
  EXPECT_TRUE(refuses([](auto& m) { m.delay_spread_s = -1e-9; }));
  EXPECT_TRUE(refuses([](auto& m) { m.doppler_factor = -1; }));
}

TEST(MessageChecks, TheReasonNamesTheFieldAndWhatIsAllowed) {
  EXPECT_EQ(problem_after<vehicle_command_t>([](auto& m) { m.rudder_rad = 90; }),
            "rudder_rad is 90; allowed is -3.14159 to 3.14159");
}

}  // namespace
}  // namespace halocline::bus
