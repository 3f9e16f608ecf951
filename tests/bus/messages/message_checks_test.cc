// SPDX-License-Identifier: BSD-3-Clause
#include "bus/messages/message_checks.h"

#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/messages/message_field.h"
#include "bus/messages/message_fields.h"
#include "tests/bus/messages_for_tests.h"

namespace halocline::bus {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::valid_message;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class Message>
class ChecksOf : public ::testing::Test {};
TYPED_TEST_SUITE(ChecksOf, testing::TypesOf<AllMessages>::Type);

// Calls change(field, number) for every double and every enumerated number of a message: the first of each
// list.
template <class Change>
struct NumberVisitor {
  Change change;
  template <class T>
  void operator()(const MessageField& field, T& value) {
    if constexpr (std::is_same_v<T, double> || std::is_same_v<T, std::int8_t>) {
      change(field, value);
    } else if constexpr (std::is_array_v<T>) {
      (*this)(field, value[0]);
    } else if constexpr (kIsList<T>) {
      ASSERT_FALSE(value.empty()) << field.name;
      (*this)(field, value[0]);
    }
  }
};

template <class Message, class Change>
void visit_numbers(Message& message, Change change) {
  NumberVisitor<Change> visitor{change};
  visit_fields(visitor, message);
}

TYPED_TEST(ChecksOf, AValidMessagePasses) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    EXPECT_EQ(problem_in(valid_message<TypeParam>(seed)), "") << "seed " << seed;
  }
}

TYPED_TEST(ChecksOf, RefusesNanAndInfinityInEveryNumberThatIsChecked) {
  auto message = valid_message<TypeParam>(2);
  visit_numbers(message, [&](const MessageField& field, auto& value) {
    using Number = std::remove_reference_t<decltype(value)>;
    if constexpr (std::is_floating_point_v<Number>) {
      for (const double bad : {kNan, kInfinity, -kInfinity}) {
        const Number good = std::exchange(value, static_cast<Number>(bad));
        EXPECT_EQ(problem_in(message).empty(), field.is_unchecked) << field.name << " = " << bad;
        value = good;
      }
    }
  });
}

TYPED_TEST(ChecksOf, RefusesEnumerationsWithoutAMeaning) {
  auto message = valid_message<TypeParam>(2);
  visit_numbers(message, [&](const MessageField& field, auto& value) {
    if constexpr (std::is_same_v<decltype(value), std::int8_t&>) {
      if (field.enumeration.empty()) return;
      const std::int8_t good = value;
      for (const double bad : {-128.0, field.min - 1, field.max + 1, 127.0}) {
        value = static_cast<std::int8_t>(bad);
        EXPECT_THAT(problem_in(message), HasSubstr("enumeration")) << field.name << " = " << bad;
      }
      value = good;
    }
  });
}

// As lcmtypes annotates each field: every number of every message is checked but these.
TEST(MessageChecks, LeaveUncheckedWhatIsAnsweredOneByOne) {
  std::set<std::string> unchecked;
  const auto collect = [&]<class Message>(Message message) {
    const auto visitor = [&](const MessageField& field, const auto&) {
      if (field.is_unchecked)
        unchecked.insert(std::string(Message::getTypeName()) + "." + std::string(field.name));
    };
    visit_fields(visitor, message);
  };
  std::apply([&](auto... message) { (collect(message), ...); }, AllMessages());
  EXPECT_THAT(unchecked, ElementsAre("best_place_query_t.place_ned_m", "link_query_t.receivers",
                                     "link_query_t.transmitters", "ray_query_t.direction",
                                     "ray_query_t.max_range_m", "ray_query_t.offset_m",
                                     "ray_query_t.sample_spacing_m", "terrain_query_t.corner_east_m",
                                     "terrain_query_t.corner_north_m", "terrain_query_t.post_spacing_m"));
}

TEST(MessageChecks, NestedMessagesAreChecked) {
  link_reply_t reply = valid_message<link_reply_t>(2);
  reply.answers[1].link.snr_db = kNan;
  EXPECT_EQ(problem_in(reply), "answers link snr_db is not a finite number");
}

template <class Message, class Change>
std::string problem_after(Change change) {
  Message message = valid_message<Message>(2);
  change(message);
  return problem_in(message);
}

TEST(MessageChecks, AModemHasOneOfThirteenErrorModels) {
  for (const int bad : {-1, 13, 127}) {
    EXPECT_NE(problem_after<modem_config_t>([&](auto& m) { m.error_model = static_cast<std::int8_t>(bad); }),
              "");
  }
  for (std::int8_t good = 0; good <= 12; ++good) {
    EXPECT_EQ(problem_after<modem_config_t>([&](auto& m) { m.error_model = good; }), "");
  }
}

TEST(MessageChecks, DepthsOfACurrentAscend) {
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
              m.wants_ack = 0;
            }),
            "");
}

TEST(MessageChecks, AnAcknowledgementComesFromOneVehicleAndNotToAPing) {
  const auto wanting = [](std::int32_t destination, std::int8_t kind) {
    return problem_after<modem_send_t>([&](auto& m) {
      m.wants_ack = 1;
      m.destination_id = destination;
      m.packet_kind = kind;
      m.num_frames = 0;
      m.frame_bytes.clear();
    });
  };
  EXPECT_EQ(wanting(2, modem_send_t::DATA), "");
  EXPECT_EQ(wanting(2, modem_send_t::MINI_PACKET), "");
  EXPECT_NE(wanting(0, modem_send_t::DATA), "");
  EXPECT_NE(wanting(2, modem_send_t::PING), "");
}

TEST(MessageChecks, NobodySendsWhatModemsMakeByThemselves) {
  for (const std::int8_t kind : {modem_send_t::PING_REPLY, modem_send_t::ACK})
    EXPECT_NE(problem_after<modem_send_t>([&](auto& m) { m.packet_kind = kind; }), "");
}

TEST(MessageChecks, FramesTogetherAreThePayloadOfData) {
  const auto with_frames = [](const std::vector<std::int32_t>& frames, std::int8_t kind) {
    return problem_after<modem_send_t>([&](auto& m) {
      m.packet_kind = kind;
      m.wants_ack = 0;
      m.payload = {1, 2, 3};
      m.payload_size = 3;
      m.frame_bytes = frames;
      m.num_frames = static_cast<std::int32_t>(frames.size());
    });
  };
  EXPECT_EQ(with_frames({}, modem_send_t::DATA), "");
  EXPECT_EQ(with_frames({1, 0, 2}, modem_send_t::DATA), "");
  EXPECT_NE(with_frames({1, 1}, modem_send_t::DATA), "");
  EXPECT_NE(with_frames({4, -1}, modem_send_t::DATA), "");
  EXPECT_NE(with_frames({1, 2}, modem_send_t::JANUS_CARGO), "");
}

TEST(MessageChecks, APingGoesToOneVehicleOrToAll) {
  for (const std::int32_t destination : {0, 2}) {
    EXPECT_EQ(problem_after<modem_send_t>([&](auto& m) {
                m.destination_id = destination;
                m.packet_kind = modem_send_t::PING;
                m.wants_ack = 0;
                m.num_frames = 0;
                m.frame_bytes.clear();
              }),
              "");
  }
}

TEST(MessageChecks, RefusesAClientNameThatNoChannelMayHave) {
  for (const char* name : {"", "A", "a.b", "a*", "with space", "a-name-that-is-longer-than-24", "\xff"}) {
    EXPECT_NE(problem_after<link_query_t>([&](auto& m) { m.client_name = name; }), "") << name;
    EXPECT_NE(problem_after<ray_query_t>([&](auto& m) { m.client_name = name; }), "") << name;
    EXPECT_NE(problem_after<node_status_t>([&](auto& m) { m.node_name = name; }), "") << name;
  }
}

TEST(MessageChecks, ATextIsOneLineWithoutControlCharacters) {
  auto status = testing::valid_message<node_status_t>(1);
  status.status_text = "idle";
  EXPECT_EQ(problem_in(status), "");
  status.status_text = "idle\x1b[2J";
  EXPECT_EQ(problem_in(status), "status_text is not one line without control characters");
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

TEST(MessageChecks, ABeamPatternHasUpToARowADegreeAndAscends) {
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
              HasSubstr("does not ascend"));
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
  EXPECT_TRUE(refuses([](auto& m) { m.strongest_path_doppler_factor = -1; }));
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
  EXPECT_TRUE(refuses([](auto& m) { m.first_path_doppler_factor = -1; }));
}

TEST(MessageChecks, TheReasonNamesTheFieldAndWhatIsAllowed) {
  EXPECT_EQ(problem_after<vehicle_command_t>([](auto& m) { m.rudder_rad = 90; }),
            "rudder_rad is 90; allowed is -3.14159 to 3.14159");
}

}  // namespace
}  // namespace halocline::bus
