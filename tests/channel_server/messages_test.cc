// SPDX-License-Identifier: BSD-3-Clause
// The messages of the channel server, from the bus to the models and back.
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/modem/beam_pattern.h"
#include "acoustics/modem/error_model.h"
#include "acoustics/modem/receiver_kind.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "bus/messages/message_checks.h"
#include "channel_server/links/link_query_service.h"
#include "channel_server/links/link_table.h"
#include "channel_server/links/ray_query_client.h"
#include "channel_server/messages/link_messages.h"
#include "channel_server/messages/packet_messages.h"
#include "channel_server/messages/world_messages.h"
#include "channel_server/modems/modem_config.h"
#include "channel_server/packets/medium_event.h"
#include "channel_server/packets/packet.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "channel_server/vehicles/state_history.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "core/check.h"
#include "core/frames.h"
#include "core/units.h"
#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;
using testing::for_s;

VehicleModem odd_modem() {
  VehicleModem modem;
  modem.modem.source_level = {171.5};
  modem.modem.min_receivable_level = {-12.25};
  modem.modem.centre_frequency_hz = 11520;
  modem.modem.bandwidth_hz = 4160;
  modem.modem.directivity_index = {3};
  modem.modem.bit_rate_bps = 160;
  modem.modem.packet_overhead = for_s(0.275);
  modem.max_payload_bytes = 77;
  modem.modem.preamble = for_s(0.25);
  modem.modem.guard_time = for_s(0.0625);
  modem.modem.doppler_tolerance = 0.002;
  modem.modem.family = "sonobuoy-3";
  modem.modem.guard_taper = for_s(0.03125);
  modem.modem.chip = for_s(0.0125);
  modem.modem.hop_count = 5;
  modem.modem.hop_clearing = for_s(0.0625);
  modem.modem.doppler_correction = 0.001;
  modem.modem.time_quantum = for_s(0.0005);
  modem.modem.error_model = acoustics::ErrorModel::kDbpskRayleigh;
  modem.modem.receiver = acoustics::ReceiverKind::kStrongestPath;
  modem.modem.receiver_loss = {3.5};
  modem.modem.receiver_channels = 4;
  modem.modem.late_echo_share = 0.5;
  modem.modem.echo_cancelled = 0.75;
  modem.modem.impulse_loss = {5};
  modem.modem.beam = acoustics::BeamPattern({{-0.5, 20}, {0.25, -3}});
  modem.when_busy = WhenBusy::kQueue;
  return modem;
}

PacketOutcome some_outcome() {
  PacketOutcome end;
  SendRequest request = testing::request_of(3, 10, 44, 5);
  request.destination_id = 4;
  request.stamped = true;
  end.packet = std::make_shared<const Packet>(Packet{request,
                                                     at_s(10.5),
                                                     {for_s(0.05), for_s(0.01), 40},
                                                     odd_modem().modem,
                                                     {1, 2, 3},
                                                     {},
                                                     {},
                                                     3,
                                                     {0, {40}},
                                                     {5}});
  end.receiver_id = 4;
  end.receiver = "v4";
  end.travel_time_s = 1.25;
  end.departure_stamp = at_s(10.5000625);
  end.measured_travel_time_s = 1.3125;
  end.cutoff = {70};
  end.budget = acoustics::link_budget({}, {}, {}, {0, 0, 5}, {900, 0, 5});
  end.propagation = PropagationUsed::kRays;
  end.path_count = 4;
  end.delay_spread_s = 0.375;
  end.doppler_factor = 1.0625;
  end.arrival_azimuth_rad = -3;
  end.arrival_elevation_rad = 0.125;
  end.statistics = {{81}, {12.5}, 0.75, 0.5, 0.625, 0.25, {{9, 77, PacketKind::kPing, 2, at_s(3), 1234}}, 1};
  return end;
}

TEST(ChannelServerMessages, AModemSurvivesTheRoundTrip) {
  const modem_config_t message = to_message(odd_modem(), at_s(3));
  EXPECT_EQ(bus::problem_in(message), "");
  EXPECT_EQ(to_modem(message), odd_modem());
  EXPECT_EQ(message.utime, 3'000'000);
}

TEST(ChannelServerMessages, EveryProfileSurvivesTheRoundTrip) {
  for (const std::string& profile : built_in_modems()) {
    VehicleModem modem = load_modem(profile);
    modem.modem.source_level = {190};  // one of the numbers that are free
    set_rates_of(load_modem(profile), modem);
    const modem_config_t message = to_message(modem, at_s(3));
    EXPECT_EQ(bus::problem_in(message), "");
    EXPECT_EQ(to_modem(message), modem);
  }
}

TEST(ChannelServerMessages, EveryErrorModelSurvivesTheRoundTrip) {
  for (const acoustics::ErrorModel model : acoustics::kErrorModels) {
    VehicleModem modem;
    modem.modem.error_model = model;
    modem.modem.chip = for_s(0.01);
    const modem_config_t message = to_message(modem, at_s(3));
    EXPECT_EQ(bus::problem_in(message), "");
    EXPECT_EQ(to_modem(message).modem.error_model, model);
  }
}

TEST(ChannelServerMessages, AProfilesOwnNumbersMayNotBeOthers) {
  const VehicleModem janus = load_modem("janus");
  modem_config_t message = to_message(janus, at_s(3));
  message.bit_rate_bps = 300;
  EXPECT_THROW(to_modem(message), InvalidArgument);
  message = to_message(janus, at_s(3));
  message.preamble_s = 0.1;
  EXPECT_THROW(to_modem(message), InvalidArgument);
  message = to_message(load_modem("micromodem-psk-1"), at_s(3));
  message.modem_profile = "micromodem-psk-99";
  EXPECT_THROW(to_modem(message), InvalidArgument);
}

TEST(ChannelServerMessages, AModemOutOfRangeIsRefused) {
  modem_config_t message = to_message(odd_modem(), at_s(3));
  message.source_level_db = 300;
  EXPECT_THROW(to_modem(message), InvalidArgument);
}

TEST(ChannelServerMessages, AStateKeepsTimePositionAndVelocity) {
  vehicle_state_t message{};
  message.utime = 1'500'000;
  message.position_ned_m[1] = 7;
  message.velocity_ned_mps[2] = -1;
  const StampedState state = to_state(message);
  EXPECT_EQ(state.time, at_s(1.5));
  EXPECT_EQ(state.position_ned_m, Vec3(0, 7, 0));
  EXPECT_EQ(state.velocity_ned_mps, Vec3(0, 0, -1));
}

TEST(ChannelServerMessages, ASendKeepsWhatNamesThePacket) {
  modem_send_t message{};
  message.utime = 2'000'000;
  message.session = 5;
  message.packet_sequence = 6;
  message.source_id = 1;
  message.destination_id = 2;
  message.packet_kind = modem_send_t::PING;
  message.payload = {9, 8, 7};
  const SendRequest request = to_request("auv1", message);
  EXPECT_EQ(request.vehicle, "auv1");
  EXPECT_EQ(request.session, 5);
  EXPECT_EQ(request.packet_sequence, 6);
  EXPECT_EQ(request.source_id, 1);
  EXPECT_EQ(request.destination_id, 2);
  EXPECT_EQ(request.start, at_s(2));
  EXPECT_EQ(request.kind, PacketKind::kPing);
  EXPECT_FALSE(request.stamped);
  EXPECT_EQ(request.payload, message.payload);
}

TEST(ChannelServerMessages, EnumerationsAreThoseOfTheBus) {
  EXPECT_EQ(static_cast<int>(SendResult::kAccepted), modem_receipt_t::ACCEPTED);
  EXPECT_EQ(static_cast<int>(SendResult::kBusy), modem_receipt_t::REFUSED_BUSY);
  EXPECT_EQ(static_cast<int>(SendResult::kTooLarge), modem_receipt_t::REFUSED_TOO_LARGE);
  EXPECT_EQ(static_cast<int>(SendResult::kUnknownVehicle), modem_receipt_t::REFUSED_UNKNOWN_VEHICLE);
  EXPECT_EQ(static_cast<int>(SendResult::kWrongSource), modem_receipt_t::REFUSED_WRONG_SOURCE);
  EXPECT_EQ(static_cast<int>(SendResult::kStale), modem_receipt_t::REFUSED_STALE);
  EXPECT_EQ(static_cast<int>(SendResult::kTooEarly), modem_receipt_t::REFUSED_TOO_EARLY);
  EXPECT_EQ(static_cast<int>(OutcomeKind::kReceived), packet_outcome_t::RECEIVED);
  EXPECT_EQ(static_cast<int>(OutcomeKind::kBelowCutoff), packet_outcome_t::BELOW_CUTOFF);
  EXPECT_EQ(static_cast<int>(OutcomeKind::kReceiverGone), packet_outcome_t::RECEIVER_GONE);
  EXPECT_EQ(static_cast<int>(OutcomeKind::kShadow), packet_outcome_t::SHADOW);
  EXPECT_EQ(static_cast<int>(OutcomeKind::kBlocked), packet_outcome_t::BLOCKED);
  EXPECT_EQ(static_cast<int>(OutcomeKind::kOutOfBand), packet_outcome_t::OUT_OF_BAND);
  EXPECT_EQ(static_cast<int>(OutcomeKind::kCollided), packet_outcome_t::COLLIDED);
  EXPECT_EQ(static_cast<int>(OutcomeKind::kHalfDuplex), packet_outcome_t::HALF_DUPLEX);
  EXPECT_EQ(static_cast<int>(OutcomeKind::kDoppler), packet_outcome_t::DOPPLER);
  EXPECT_EQ(static_cast<int>(OutcomeKind::kForeign), packet_outcome_t::FOREIGN);
  EXPECT_EQ(static_cast<int>(OutcomeKind::kTooWeak), packet_outcome_t::TOO_WEAK);
  EXPECT_EQ(static_cast<int>(OutcomeKind::kTooSteep), packet_outcome_t::TOO_STEEP);
  EXPECT_EQ(static_cast<int>(OutcomeKind::kOutOfReach), packet_outcome_t::OUT_OF_REACH);
  EXPECT_EQ(static_cast<int>(OutcomeKind::kAsleep), packet_outcome_t::ASLEEP);
  EXPECT_EQ(static_cast<int>(OutcomeKind::kExtraLoss), packet_outcome_t::EXTRA_LOSS);
  EXPECT_EQ(static_cast<int>(OutcomeKind::kNoPower), packet_outcome_t::NO_POWER);
  EXPECT_EQ(static_cast<int>(OutcomeKind::kOutOfWater), packet_outcome_t::OUT_OF_WATER);
  EXPECT_EQ(static_cast<int>(OutcomeKind::kNoTerrain), packet_outcome_t::NO_TERRAIN);
  EXPECT_EQ(static_cast<int>(ModemEventKind::kTransmissionBegan), modem_event_t::TRANSMISSION_BEGAN);
  EXPECT_EQ(static_cast<int>(ModemEventKind::kTransmissionEnded), modem_event_t::TRANSMISSION_ENDED);
  EXPECT_EQ(static_cast<int>(ModemEventKind::kPacketDetected), modem_event_t::PACKET_DETECTED);
  EXPECT_EQ(static_cast<int>(ModemEventKind::kPacketEnded), modem_event_t::PACKET_ENDED);
  EXPECT_EQ(static_cast<int>(ModemEventKind::kCarrierBegan), modem_event_t::CARRIER_BEGAN);
  EXPECT_EQ(static_cast<int>(ModemEventKind::kCarrierEnded), modem_event_t::CARRIER_ENDED);
  EXPECT_EQ(static_cast<int>(ModemEventKind::kHeaderReceived), modem_event_t::HEADER_RECEIVED);
  EXPECT_EQ(static_cast<int>(OutcomeKind::kBitErrors), packet_outcome_t::BIT_ERRORS);
  EXPECT_EQ(static_cast<int>(OutcomeKind::kNotAcquired), packet_outcome_t::NOT_ACQUIRED);
  EXPECT_EQ(static_cast<int>(PropagationUsed::kStraight), packet_outcome_t::STRAIGHT);
  EXPECT_EQ(static_cast<int>(PropagationUsed::kRays), packet_outcome_t::RAYS);
  EXPECT_EQ(static_cast<int>(PropagationUsed::kStraightWithoutBottom),
            packet_outcome_t::STRAIGHT_WITHOUT_BOTTOM);
  EXPECT_EQ(static_cast<int>(SendResult::kQueued), modem_receipt_t::QUEUED);
  EXPECT_EQ(static_cast<int>(SendResult::kQueueFull), modem_receipt_t::REFUSED_QUEUE_FULL);
  EXPECT_EQ(static_cast<int>(PacketKind::kData), modem_send_t::DATA);
  EXPECT_EQ(static_cast<int>(PacketKind::kPing), modem_send_t::PING);
  EXPECT_EQ(static_cast<int>(SendResult::kNoRate), modem_receipt_t::REFUSED_NO_RATE);
  EXPECT_EQ(static_cast<int>(SendResult::kNoKind), modem_receipt_t::REFUSED_NO_KIND);
  EXPECT_EQ(static_cast<int>(SendResult::kNoModem), modem_receipt_t::REFUSED_NO_MODEM);
  EXPECT_EQ(static_cast<int>(PacketKind::kAck), modem_receive_t::ACK);
  EXPECT_EQ(static_cast<int>(PacketKind::kMiniPacket), modem_send_t::MINI_PACKET);
  EXPECT_EQ(static_cast<int>(PacketKind::kMiniPacket), modem_receive_t::MINI_PACKET);
  EXPECT_EQ(static_cast<int>(PacketKind::kJanus), modem_send_t::JANUS);
  EXPECT_EQ(static_cast<int>(PacketKind::kJanus), modem_receive_t::JANUS);
  EXPECT_EQ(static_cast<int>(PacketKind::kJanusCargo), modem_send_t::JANUS_CARGO);
  EXPECT_EQ(static_cast<int>(PacketKind::kJanusCargo), modem_receive_t::JANUS_CARGO);
  EXPECT_EQ(static_cast<int>(PacketKind::kData), modem_receive_t::DATA);
  EXPECT_EQ(static_cast<int>(PacketKind::kPing), modem_receive_t::PING);
  EXPECT_EQ(static_cast<int>(PacketKind::kPingReply), modem_receive_t::PING_REPLY);
  EXPECT_EQ(static_cast<int>(Multipath::kUnlikely), link_t::MULTIPATH_UNLIKELY);
  EXPECT_EQ(static_cast<int>(Multipath::kLikely), link_t::MULTIPATH_LIKELY);
  EXPECT_EQ(static_cast<int>(Multipath::kUnknown), link_t::MULTIPATH_UNKNOWN);
  EXPECT_EQ(static_cast<int>(LinkAnswer::Status::kUnknownVehicle), link_answer_t::UNKNOWN_VEHICLE);
  EXPECT_EQ(static_cast<int>(LinkAnswer::Status::kBadInput), link_answer_t::BAD_INPUT);
  EXPECT_EQ(static_cast<int>(RayAnswer::Kind::kHit), ray_reply_t::HIT);
  EXPECT_EQ(static_cast<int>(RayAnswer::Kind::kMiss), ray_reply_t::MISS);
  EXPECT_EQ(static_cast<int>(RayAnswer::Kind::kOutside), ray_reply_t::OUTSIDE);
  EXPECT_EQ(static_cast<int>(RayAnswer::Kind::kNoData), ray_reply_t::NO_DATA);
  EXPECT_EQ(static_cast<int>(RayAnswer::Kind::kBelowBottom), ray_reply_t::BELOW_BOTTOM);
  EXPECT_EQ(static_cast<int>(RayAnswer::Kind::kBadInput), ray_reply_t::BAD_INPUT);
}

TEST(ChannelServerMessages, AnOutcomeHoldsWhatDecidedIt) {
  const packet_outcome_t outcome = to_outcome(some_outcome(), at_s(11.3));
  EXPECT_EQ(bus::problem_in(outcome), "");
  EXPECT_EQ(outcome.utime, 11'300'000);
  EXPECT_EQ(outcome.departure_utime, 10'500'000);
  EXPECT_EQ(outcome.source_id, 3);
  EXPECT_EQ(outcome.receiver_id, 4);
  EXPECT_EQ(outcome.travel_time_s, 1.25);
  EXPECT_EQ(outcome.duration_s, 0.05);
  EXPECT_EQ(outcome.range_m, 900);
  EXPECT_EQ(outcome.cutoff_level_db, 70);
  EXPECT_EQ(outcome.received_level_db, some_outcome().budget.received_level.value);
  EXPECT_EQ(outcome.propagation_used, packet_outcome_t::RAYS);
  EXPECT_EQ(outcome.num_paths, 4);
  EXPECT_EQ(outcome.delay_spread_s, 0.375);
  EXPECT_EQ(outcome.strongest_path_doppler_factor, 1.0625);
  EXPECT_EQ(outcome.arrival_azimuth_rad, -3);
  EXPECT_EQ(outcome.arrival_elevation_rad, 0.125);
  EXPECT_EQ(outcome.interference_level_db, 81);
  EXPECT_EQ(outcome.sinr_db, 12.5);
  EXPECT_EQ(outcome.acquisition_probability, 0.75);
  EXPECT_EQ(outcome.success_probability, 0.5);
  EXPECT_EQ(outcome.acquisition_draw, 0.625);
  EXPECT_EQ(outcome.success_draw, 0.25);
  ASSERT_EQ(outcome.num_colliders, 1);
  EXPECT_EQ(outcome.colliders[0].source_id, 9);
  EXPECT_EQ(outcome.colliders[0].packet_sequence, 77);
  EXPECT_EQ(outcome.colliders[0].packet_kind, modem_receive_t::PING);
  EXPECT_EQ(outcome.colliders[0].send_session, 1234);
}

TEST(ChannelServerMessages, AReceiverCannotKnowWhenAPacketWithoutAStampLeft) {
  PacketOutcome end = some_outcome();
  EXPECT_EQ(to_receive(end, at_s(11.3)).departure_utime, 10'500'063) << "by the sender's clock";
  EXPECT_EQ(to_receive(end, at_s(11.3)).travel_time_s, 1.3125) << "as measured";
  Packet silent = *end.packet;
  silent.request.stamped = false;
  end.packet = std::make_shared<const Packet>(silent);
  EXPECT_EQ(to_receive(end, at_s(11.3)).stamped, 0);
  EXPECT_EQ(to_receive(end, at_s(11.3)).departure_utime, 0);
  EXPECT_EQ(to_receive(end, at_s(11.3)).travel_time_s, 0);
  EXPECT_EQ(to_outcome(end, at_s(11.3)).travel_time_s, 1.25);  // the ledger knows
}

TEST(ChannelServerMessages, WhoOverhearsAnAnswerDoesNotKnowWhenTheQuestionLeft) {
  PacketOutcome end = some_outcome();
  end.two_way_travel_time_s = 2.5;
  end.receiver_id = end.packet->request.destination_id;
  EXPECT_EQ(to_receive(end, at_s(11.3)).two_way_travel_time_s, 2.5);
  end.receiver_id += 1;
  EXPECT_EQ(to_receive(end, at_s(11.3)).two_way_travel_time_s, 0);
}

TEST(ChannelServerMessages, AReceivedPacketCarriesItsPayload) {
  const modem_receive_t receive = to_receive(some_outcome(), at_s(11.3));
  EXPECT_EQ(bus::problem_in(receive), "");
  EXPECT_EQ(receive.payload_size, 5);
  EXPECT_EQ(receive.payload, some_outcome().packet->request.payload);
  EXPECT_EQ(receive.destination_id, 4);
  EXPECT_EQ(receive.snr_db, some_outcome().budget.snr.value);
}

TEST(ChannelServerMessages, AReceiptHoldsStartAndDuration) {
  const Receipt receipt{"v3", 7, 44, SendResult::kAccepted, at_s(10), for_s(0.5)};
  const modem_receipt_t message = to_message(receipt, at_s(10.1));
  EXPECT_EQ(bus::problem_in(message), "");
  EXPECT_EQ(message.utime, 10'100'000);
  EXPECT_EQ(message.start_utime, 10'000'000);
  EXPECT_EQ(message.duration_s, 0.5);
  EXPECT_EQ(message.send_session, 7);
}

TEST(ChannelServerMessages, AModemThatCannotBeReadIsTheProblemOfItsEndAlone) {
  link_query_t query{};
  query.client_name = "me";
  query.transmitters.resize(1);
  query.receivers.resize(1);
  query.receivers[0].modem_choice = link_end_t::MODEM_GIVEN;
  query.receivers[0].modem = to_message(odd_modem(), at_s(0));
  query.receivers[0].modem.bit_rate_bps = std::numeric_limits<double>::quiet_NaN();
  const LinkQuery converted = to_query(query);
  EXPECT_EQ(converted.transmitters[0].problem, "");
  EXPECT_NE(converted.receivers[0].problem, "");
  EXPECT_FALSE(converted.receivers[0].modem);
}

TEST(ChannelServerMessages, ABatchOfTilesNamesTheirOriginsAndSpacing) {
  const RayQueryBatch batch{7, std::vector<Vec3>(64, Vec3(1, 2, 3)), 25};
  const ray_query_t message = to_message(batch, "channel-xyz", at_s(9));
  EXPECT_EQ(bus::problem_in(message), "");
  EXPECT_EQ(message.query_mode, ray_query_t::DEPTH_TILES);
  EXPECT_EQ(message.num_rays, 64);
  EXPECT_EQ(message.offset_m.at(63), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(message.sample_spacing_m, 25);
}

}  // namespace
}  // namespace halocline::channel_server
