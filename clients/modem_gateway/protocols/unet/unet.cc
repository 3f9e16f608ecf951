// SPDX-License-Identifier: BSD-3-Clause
// UnetStack gateway: JSON lines of fjage, with the agents node, arp, phy, ranging and uwlink.
//
// A frame's protocol number is in its header. Frames are sent one after the other; up to 16 wait. A datagram
// with `reliability` is acknowledged by the receiver's modem and sent up to three times; its one notification
// is DatagramDeliveryNtf or DatagramFailureNtf. Such datagrams to one node are sent one after the other,
// without delaying those to other nodes. A received frame is reported when it is detected (RxFrameStartNtf)
// and when it ends (RxFrameNtf, BadFrameNtf or CollisionNtf). The modem's time is the vehicle's clock.
// Baseband signals and fragmentation are not supported. Options: none.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <optional>
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
#include "clients/modem_gateway/protocols/unet/unet_job.h"
#include "clients/modem_gateway/protocols/unet/unet_json.h"
#include "clients/modem_gateway/protocols/unet/unet_parameters.h"
#include "core/names.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {
namespace {

using nlohmann::json;

constexpr std::ptrdiff_t kMaxWaiting = 16;
constexpr int kTries = 3;
// Time after the end of a frame within which an acknowledgement or a ping's answer comes from the greatest
// range.
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
    const auto job = job_of(receipt.packet_sequence);
    if (job == jobs_.end()) return;
    parameters_.note_busy(is_accepted(receipt));
    if (!is_accepted(receipt)) {
      port_.note("send-refused", "result=" + std::to_string(receipt.receipt_result));
      try_again(job);
      return send_next();
    }
    job->began_us = port_.clock_at(SimTime::from_utime(receipt.start_utime)).to_utime();
    job->ends = SimTime::from_utime(receipt.start_utime) + SimDuration::from_seconds(receipt.duration_s);
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
    SimTime next = SimTime::never();
    for (const Job& job : jobs_) next = std::min({next, job.ends, job.until});
    return next;
  }
  void step() override {
    for (auto job = jobs_.begin(); job != jobs_.end();) {
      const auto this_job = job++;  // the job may be erased
      if (port_.now() >= this_job->ends)
        end_of_sound(this_job);
      else if (port_.now() >= this_job->until)
        try_again(this_job);
    }
    send_next();
  }

 private:
  using Job = UnetJob;
  using Jobs = std::list<Job>;

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
    if (request.type == "ClearReq" || request.type == "DatagramCancelReq") return cancel(request);
    if (request.type.ends_with("Req"))
      return refuse(request, request.type.find("Baseband") != std::string::npos ? "no waveform channel"
                                                                                : "not supported");
    hosts_.answer(request, {{"clazz", "org.arl.fjage.Message"}, {"perf", "NOT_UNDERSTOOD"}});
  }

  void agree(const UnetRequest& request) {
    hosts_.answer(request, {{"clazz", "org.arl.fjage.Message"}, {"perf", "AGREE"}});
  }
  void refuse(const UnetRequest& request, const std::string& reason) { hosts_.refuse(request, reason); }

  // Cancels all frames that wait, or the one with the given id, and tells their hosts.
  void cancel(const UnetRequest& request) {
    agree(request);
    const std::string id = text_of(request.data, "id");
    for (auto job = jobs_.begin(); job != jobs_.end();) {
      const auto this_job = job++;
      if (!this_job->has_begun() && (id.empty() || id == this_job->request.id)) fail(this_job);
    }
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
    if (!data || job.address < 0) return refuse(request, "bad request");
    if (!is_unet_protocol(protocol)) return refuse(request, "bad protocol");
    job.protocol = static_cast<std::int32_t>(protocol);
    job.data = *data;
    if (std::ssize(job.data) > unet_channel(job.channel).frame_bytes) return refuse(request, "data too long");
    job.wants_ack = !is_frame && flag_of(request.data, "reliability");
    if (job.wants_ack && job.address == 0) return refuse(request, "no reliable broadcast");
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
    const auto waiting =
        std::count_if(jobs_.begin(), jobs_.end(), [](const Job& j) { return !j.has_begun(); });
    if (waiting >= kMaxWaiting) return refuse(job.request, "busy");
    agree(job.request);
    jobs_.push_back(std::move(job));
    send_next();
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

  Jobs::iterator job_of(std::int64_t sequence) {
    return std::find_if(jobs_.begin(), jobs_.end(),
                        [&](const Job& job) { return job.has_begun() && job.sequence == sequence; });
  }

  // Sends the first waiting job, unless a transmission is in progress. Jobs to a node from which an earlier
  // job still awaits an answer are skipped.
  void send_next() {
    if (std::any_of(jobs_.begin(), jobs_.end(), [](const Job& job) { return job.is_sending(); })) return;
    for (auto job = jobs_.begin(); job != jobs_.end(); ++job) {
      const bool waits = std::any_of(jobs_.begin(), job, [&](const Job& before) {
        return before.has_begun() && before.address == job->address;
      });
      if (!job->has_begun() && !waits) return transmit(job);
    }
  }

  void transmit(Jobs::iterator job) {
    --job->tries_left;
    job->ends = job->until = SimTime::never();
    job->sequence = port_.send(job->start, vehicle_of(job->address), job->data,
                               {.kind = job->is_ping ? modem_send_t::PING : modem_send_t::DATA,
                                .wants_ack = job->wants_ack,
                                .rate_number = job->channel,
                                .source_level_db = parameters_.source_level_db(job->channel),
                                .header_number = job->protocol});
    if (job->sequence == kNotSent) fail(job);
  }

  void end_of_sound(Jobs::iterator job) {
    parameters_.note_busy(false);
    job->ends = SimTime::never();
    if (job->is_ping || job->wants_ack) {
      job->until = port_.now() + kAnswerWithin;
      return;
    }
    const bool is_datagram = job->request.type == "DatagramReq" && job->request.recipient != "phy";
    hosts_.reply(job->request,
                 is_datagram ? "org.arl.unet.DatagramTransmissionNtf" : "org.arl.unet.phy.TxFrameNtf",
                 {{"type", job->channel}, {"txTime", job->began_us}, {"to", job->address}});
    jobs_.erase(job);
  }

  // Repeats a frame that was refused, or that had no answer in time.
  void try_again(Jobs::iterator job) {
    if (job->tries_left <= 0) return fail(job);
    job->start = SimTime();
    transmit(job);
  }

  void fail(Jobs::iterator job) {
    if (job->wants_ack)
      hosts_.reply(job->request, "org.arl.unet.DatagramFailureNtf", {{"to", job->address}});
    else
      hosts_.reply(job->request, "org.arl.fjage.Message", {{"perf", "FAILURE"}});
    jobs_.erase(job);
  }

  void take_answer(const modem_receive_t& packet) {
    const auto job = job_of(packet.packet_sequence);
    if (job == jobs_.end()) return;
    const bool is_range = packet.packet_kind == modem_receive_t::PING_REPLY;
    const bool is_good_ack =
        packet.packet_kind == modem_receive_t::ACK && !packet.payload.empty() && (packet.payload[0] & 1) != 0;
    if (is_range)
      report_range(*job, packet.two_way_travel_time_s);
    else if (is_good_ack)
      hosts_.reply(job->request, "org.arl.unet.DatagramDeliveryNtf", {{"to", job->address}});
    else
      return;
    jobs_.erase(job);
    send_next();
  }

  void report_range(const Job& job, double two_way_s) {
    hosts_.notify(kRangingTopic, "org.arl.unet.localization.RangeNtf",
                  {{"from", address_of(vehicle_id_)},
                   {"to", job.address},
                   {"range", two_way_s / 2 * parameters_.sound_speed_mps()},
                   {"offset", nullptr},
                   {"validity", true},
                   {"sender", "ranging"},
                   {"inReplyTo", job.request.id}});
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
  Jobs jobs_;
};

}  // namespace

std::unique_ptr<Protocol> make_unet(ProtocolContext context) {
  return std::make_unique<Unet>(std::move(context));
}

}  // namespace halocline::modem_gateway
