// SPDX-License-Identifier: BSD-3-Clause
// UnetStack gateway: JSON lines of fjage, agents node, arp, phy, ranging and uwlink.
//
// A frame's protocol number goes in its header. Frames are sent one after the other; up to 16 wait. With `reliability` a frame is
// acknowledged by the receiver's modem and repeated twice. A frame is reported when it is detected (RxFrameStartNtf) and when it ends
// (RxFrameNtf, BadFrameNtf or CollisionNtf). The modem's time is the vehicle's clock. Left out: baseband signals, fragmentation.
// Options: none.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "clients/modem/modem_client.h"
#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/modem_gateway/protocols/fields.h"
#include "clients/modem_gateway/protocols/line_reader.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "clients/modem_gateway/protocols/protocols.h"
#include "clients/modem_gateway/protocols/unet/unet_hosts.h"
#include "clients/modem_gateway/protocols/unet/unet_json.h"
#include "clients/modem_gateway/protocols/unet/unet_parameters.h"
#include "core/names.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxWaiting = 16;
constexpr int kTries = 3;
// Beyond the end of a frame, for an acknowledgement or a ping's answer of the greatest range.
constexpr SimDuration kAnswerWithin = SimDuration::from_milliseconds(5000);

const std::string kPhyTopic = "#phy__ntf", kRangingTopic = "#ranging__ntf";

class Unet : public Protocol {
 public:
  explicit Unet(ProtocolContext context)
      : port_(context.port),
        addresses_(context.addresses),
        vehicle_id_(context.vehicle_id),
        parameters_(context),
        vehicles_(std::move(context.vehicles)),
        hosts_(port_, [this](const UnetRequest& request) { take(request); }) {
    context.options.require_all_taken();
  }

  std::optional<clients::ListenOptions> listening() const override {
    return clients::ListenOptions{.wakes = {}, .promiscuous = true, .events = true};
  }
  void on_opened(ClientId client) override { hosts_.open(client); }
  void on_closed(ClientId client) override { hosts_.close(client); }
  void on_bytes(ClientId client, std::string_view bytes) override { hosts_.take(client, bytes); }

  void on_receipt(const modem_receipt_t& receipt) override {
    if (!sending_ || receipt.packet_sequence != sending_->sequence) return;
    const bool accepted = receipt.receipt_result == modem_receipt_t::ACCEPTED ||
                          receipt.receipt_result == modem_receipt_t::QUEUED;
    parameters_.note_busy(accepted);
    if (!accepted) {
      port_.note("send-refused", "result=" + std::to_string(receipt.receipt_result));
      return try_again();
    }
    sending_->began_us = port_.clock_at(SimTime::from_utime(receipt.start_utime)).to_utime();
    sending_->ends = SimTime::from_utime(receipt.start_utime) + SimDuration::from_seconds(receipt.duration_s);
    sending_->until = SimTime::never();
  }

  void on_packet(const modem_receive_t& packet) override {
    parameters_.note_noise(packet.noise_level_db);
    const bool is_answer = port_.is_own(packet.send_session) && packet.destination_id == vehicle_id_;
    if (is_answer) return take_answer(packet);
    if (packet.packet_kind != modem_receive_t::DATA || !parameters_.receives()) return;
    report_frame(packet);
  }

  void on_event(const modem_event_t& event) override {
    if (event.modem_event != modem_event_t::PACKET_DETECTED || !parameters_.receives()) return;
    hosts_.notify(kPhyTopic, "org.arl.unet.phy.RxFrameStartNtf",
                  {{"type", channel_of(event.rate_number)},
                   {"rxTime", event.arrival_utime},
                   {"rssi", event.level_db},
                   {"detector", 1.0},
                   {"sender", "phy"}});
  }

  void on_loss(const packet_outcome_t& loss) override {
    parameters_.note_noise(loss.noise_level_db);
    if (!parameters_.receives()) return;
    const int type = channel_of(loss.rate_number);
    const SimTime arrival =
        SimTime::from_utime(loss.departure_utime) + SimDuration::from_seconds(loss.travel_time_s);
    const std::int64_t arrival_us = port_.clock_at(arrival).to_utime();
    if (loss.outcome == packet_outcome_t::COLLIDED)
      return hosts_.notify(kPhyTopic, "org.arl.unet.phy.CollisionNtf",
                           {{"type", type}, {"rxTime", arrival_us}, {"sender", "phy"}});
    hosts_.notify(kPhyTopic, "org.arl.unet.phy.BadFrameNtf",
                  {{"type", type},
                   {"rxTime", arrival_us},
                   {"rssi", loss.received_level_db},
                   {"data", unet_array(std::span<const std::uint8_t>())},
                   {"sender", "phy"}});
  }

  SimTime next() const override {
    return sending_ ? std::min(sending_->ends, sending_->until) : SimTime::never();
  }
  void step() override {
    if (sending_ && port_.now() >= sending_->ends) end_of_sound();
    if (sending_ && port_.now() >= sending_->until) try_again();
  }

 private:
  // A frame, or a ping, that a host asked for.
  struct Job {
    UnetRequest request;
    bool is_ping = false;
    int channel = kUnetData;
    std::int32_t address = 0;
    std::int32_t protocol = 0;
    std::vector<std::uint8_t> data;
    bool wants_ack = false;
    SimTime start;
    int tries_left = 1;
    std::int64_t sequence = -1, began_us = 0;
    SimTime ends = SimTime::never(), until = SimTime::never();
  };

  static int channel_of(std::int32_t rate) { return rate == kUnetControl ? kUnetControl : kUnetData; }
  std::int32_t address_of(std::int32_t vehicle_id) const {
    return vehicle_id == kBroadcastId ? 0 : addresses_.address_of(vehicle_id).value_or(vehicle_id);
  }
  std::int32_t vehicle_of(std::int32_t address) const {
    return address == 0 ? kBroadcastId : addresses_.vehicle_of(address);
  }

  void take(const UnetRequest& request) {
    if (request.type == "ParameterReq") return hosts_.answer(request, parameters_.answer(request));
    if (request.type == "DatagramReq" || request.type == "TxFrameReq") return take_frame(request);
    if (request.type == "RangeReq") return take_range(request);
    if (request.type == "AddressResolutionReq") return resolve(request);
    if (request.type == "ClearReq" || request.type == "DatagramCancelReq") {
      waiting_.clear();
      return agree(request);
    }
    if (request.type.ends_with("Req"))
      return refuse(request, request.type.find("Baseband") != std::string::npos ? "no waveform channel"
                                                                                : "not supported");
    hosts_.answer(request, {{"clazz", "org.arl.fjage.Message"}, {"perf", "NOT_UNDERSTOOD"}});
  }

  void agree(const UnetRequest& request) {
    hosts_.answer(request, {{"clazz", "org.arl.fjage.Message"}, {"perf", "AGREE"}});
  }
  void refuse(const UnetRequest& request, const std::string& reason) {
    hosts_.answer(request, {{"clazz", "org.arl.unet.RefuseRsp"}, {"perf", "REFUSE"}, {"reason", reason}});
  }

  void take_frame(const UnetRequest& request) {
    Job job;
    job.request = request;
    const bool is_frame = request.type == "TxFrameReq";
    job.channel = is_frame ? static_cast<int>(integer_of(request.data, "type", kUnetControl)) : kUnetData;
    job.address = static_cast<std::int32_t>(integer_of(request.data, "to"));
    const std::int64_t protocol = integer_of(request.data, "protocol");
    const auto data = unet_bytes(request.data.contains("data") ? request.data["data"] : json());
    if (job.channel != kUnetControl && job.channel != kUnetData) return refuse(request, "bad type");
    if (!data || protocol < 0 || protocol > 63 || job.address < 0) return refuse(request, "bad request");
    job.protocol = static_cast<std::int32_t>(protocol);
    job.data = *data;
    if (std::ssize(job.data) > unet_channel(job.channel).frame_bytes) return refuse(request, "data too long");
    job.wants_ack = !is_frame && flag_of(request.data, "reliability") && job.address != 0;
    job.tries_left = job.wants_ack ? kTries : 1;
    const auto at_us = integer_of(request.data, "txTime");
    job.start = at_us > 0 ? port_.instant_of(SimTime::from_utime(at_us)) : SimTime();
    if (job.start > port_.now() + kMaxAhead) return refuse(request, "txTime too far ahead");
    accept(std::move(job));
  }

  void take_range(const UnetRequest& request) {
    Job job;
    job.request = request;
    job.is_ping = true;
    job.channel = kUnetControl;
    job.address = static_cast<std::int32_t>(integer_of(request.data, "to"));
    const std::int32_t to = vehicle_of(job.address);
    if (to == kBroadcastId || to == vehicle_id_) return refuse(request, "bad address");
    accept(std::move(job));
  }

  void accept(Job job) {
    if (waiting_.size() >= kMaxWaiting) return refuse(job.request, "busy");
    agree(job.request);
    waiting_.push_back(std::move(job));
    if (!sending_) send_next();
  }

  void resolve(const UnetRequest& request) {
    const std::string name = text_of(request.data, "name");
    const auto vehicle = std::find_if(vehicles_.begin(), vehicles_.end(),
                                      [&](const NamedVehicle& v) { return v.name == name; });
    const auto number = integer_in(name, 0, 65535);
    if (vehicle == vehicles_.end() && !number) return refuse(request, "unknown name");
    const std::int64_t address = vehicle == vehicles_.end() ? *number : address_of(vehicle->id);
    hosts_.answer(request, {{"clazz", "org.arl.unet.addr.AddressResolutionRsp"},
                            {"perf", "INFORM"},
                            {"name", name},
                            {"address", address}});
  }

  void send_next() {
    if (waiting_.empty()) return;
    sending_ = std::move(waiting_.front());
    waiting_.pop_front();
    transmit();
  }

  void transmit() {
    Job& job = *sending_;
    --job.tries_left;
    clients::SendOptions options{.kind = job.is_ping ? modem_send_t::PING : modem_send_t::DATA,
                                 .wants_ack = job.wants_ack,
                                 .rate_number = job.channel,
                                 .source_level_db = parameters_.source_level_db(job.channel),
                                 .header_number = job.protocol};
    job.sequence = port_.send(job.start, vehicle_of(job.address), job.data, std::move(options));
    job.ends = SimTime::never();
    job.until = std::max(job.start, port_.now()) + kReceiptWithin;
  }

  void end_of_sound() {
    parameters_.note_busy(false);
    Job& job = *sending_;
    job.ends = SimTime::never();
    if (!job.is_ping) {
      const bool is_datagram = job.request.type == "DatagramReq" && job.request.recipient != "phy";
      hosts_.reply(job.request,
                   is_datagram ? "org.arl.unet.DatagramTransmissionNtf" : "org.arl.unet.phy.TxFrameNtf",
                   {{"type", job.channel}, {"txTime", job.began_us}, {"to", job.address}});
    }
    if (!job.is_ping && !job.wants_ack) return finish();
    job.until = port_.now() + kAnswerWithin;
  }

  // Refused, or without an answer.
  void try_again() {
    if (sending_->tries_left > 0) {
      sending_->start = SimTime();
      return transmit();
    }
    if (sending_->wants_ack)
      hosts_.reply(sending_->request, "org.arl.unet.DatagramFailureNtf", {{"to", sending_->address}});
    else if (!sending_->is_ping)
      hosts_.reply(sending_->request, "org.arl.fjage.Message", {{"perf", "FAILURE"}});
    finish();
  }
  void finish() {
    parameters_.note_busy(false);
    sending_.reset();
    send_next();
  }

  void take_answer(const modem_receive_t& packet) {
    if (!sending_ || packet.packet_sequence != sending_->sequence) return;
    if (packet.packet_kind == modem_receive_t::PING_REPLY) {
      const double range_m = packet.two_way_travel_time_s / 2 * parameters_.sound_speed_mps();
      hosts_.notify(kRangingTopic, "org.arl.unet.localization.RangeNtf",
                    {{"from", address_of(vehicle_id_)},
                     {"to", sending_->address},
                     {"range", range_m},
                     {"offset", nullptr},
                     {"validity", true},
                     {"sender", "ranging"},
                     {"inReplyTo", sending_->request.id}});
      return finish();
    }
    if (packet.packet_kind != modem_receive_t::ACK || packet.payload.empty() || (packet.payload[0] & 1) == 0)
      return;
    hosts_.reply(sending_->request, "org.arl.unet.DatagramDeliveryNtf", {{"to", sending_->address}});
    finish();
  }

  void report_frame(const modem_receive_t& packet) {
    hosts_.notify(kPhyTopic, "org.arl.unet.phy.RxFrameNtf",
                  {{"from", address_of(packet.source_id)},
                   {"to", address_of(packet.destination_id)},
                   {"protocol", packet.header_number},
                   {"type", channel_of(packet.rate_number)},
                   {"data", unet_array(packet.payload)},
                   {"rxTime", packet.arrival_utime},
                   {"rssi", packet.received_level_db},
                   {"snr", packet.snr_db},
                   {"errors", 0},
                   {"bitErrors", 0},
                   {"sender", "phy"}});
  }

  ProtocolPort& port_;
  AddressBook& addresses_;
  std::int32_t vehicle_id_;
  UnetParameters parameters_;
  std::vector<NamedVehicle> vehicles_;
  UnetHosts hosts_;
  std::deque<Job> waiting_;
  std::optional<Job> sending_;
};

}  // namespace

std::unique_ptr<Protocol> make_unet(ProtocolContext context) {
  return std::make_unique<Unet>(std::move(context));
}

}  // namespace halocline::modem_gateway
