// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/s2c/s2c_messages.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "clients/modem_gateway/protocols/fields.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "core/elementary.h"
#include "core/frames.h"

namespace halocline::modem_gateway {
namespace {

constexpr double kSensitivity_db = 190, kGoodIntegrity = 100, kIntegrityPerDb = 3;

std::int64_t microseconds(double seconds) { return std::llround(seconds * 1e6); }

S2cQuality quality(const S2cCore& core, double duration_s, double level_db, double sinr_db,
                   double doppler_factor) {
  return {microseconds(duration_s), std::lround(level_db - kSensitivity_db),
          std::lround(std::clamp(kGoodIntegrity + kIntegrityPerDb * sinr_db, 0.0, 255.0)),
          static_cast<double>(core.setting("!CA")) * (doppler_factor - 1)};
}

// Returns "p3," for protocol id 3 when the setting @ZF shows protocol ids, else "".
std::string protocol_field(const S2cCore& core, const S2cPayload& payload) {
  return core.setting("@ZF") != 0 ? fmt::format("p{},", payload.protocol) : "";
}

std::string burst_message(const S2cCore& core, const modem_receive_t& packet, const S2cPayload& payload,
                          const S2cQuality& q) {
  const double bits = 8 * static_cast<double>(packet.payload.size());
  return fmt::format("RECV,{}{},{},{},{:.0f},{},{},{},{:.4f},", protocol_field(core, payload),
                     payload.bytes.size(), core.address_of(packet.source_id),
                     core.address_of(packet.destination_id),
                     packet.duration_s > 0 ? bits / packet.duration_s : 0, q.rssi, q.integrity,
                     microseconds(packet.travel_time_s), q.velocity_mps);
}

std::string instant_message(const S2cCore& core, const modem_receive_t& packet, const S2cPayload& payload,
                            const S2cQuality& q) {
  const std::string head =
      fmt::format("{}{},{},{}", protocol_field(core, payload), payload.bytes.size(),
                  core.address_of(packet.source_id), core.address_of(packet.destination_id));
  const std::string tail =
      fmt::format("{},{},{},{:.4f},", q.duration_us, q.rssi, q.integrity, q.velocity_mps);
  switch (payload.kind) {
    case S2cKind::kSynchronous:
      return fmt::format("RECVIMS,{},{},{}", head,
                         S2cCore::clock_us(SimTime::from_utime(packet.arrival_utime)), tail);
    case S2cKind::kPiggyBack:
      return fmt::format("RECVPBM,{},{}", head, tail);
    case S2cKind::kPlain:
    case S2cKind::kForced:
      break;
  }
  const char* flag = packet.wants_ack ? "ack" : payload.kind == S2cKind::kForced ? "force" : "noack";
  return fmt::format("RECVIM,{},{},{}", head, flag, tail);
}

// Returns roll, pitch and yaw as the vehicle's sensors measure them; for a node without sensors, the true
// attitude.
EulerAngles attitude_of(const ProtocolPort& port) {
  if (const vehicle_sensors_t* s = port.sensors()) return {s->roll_rad, s->pitch_rad, s->heading_rad};
  const vehicle_state_t* state = port.state();
  if (state == nullptr) return {};
  const double* q = state->orientation_wxyz;
  return to_euler(Quaternion(q[0], q[1], q[2], q[3]));
}

}  // namespace

S2cQuality quality_of(const S2cCore& core, const modem_receive_t& p) {
  return quality(core, p.duration_s, p.received_level_db, p.sinr_db, p.strongest_path_doppler_factor);
}

S2cQuality quality_of(const S2cCore& core, const packet_outcome_t& p) {
  return quality(core, p.duration_s, p.received_level_db, p.sinr_db, p.strongest_path_doppler_factor);
}

std::string received_message(const S2cCore& core, const modem_receive_t& packet) {
  const S2cPayload payload = s2c_payload(packet);
  const S2cQuality q = quality_of(core, packet);
  return (packet.rate_number == kS2cBurstRate ? burst_message(core, packet, payload, q)
                                              : instant_message(core, packet, payload, q)) +
         std::string(as_text(payload.bytes));
}

std::string receive_end(const S2cCore& core, const modem_receive_t& packet) {
  const S2cQuality q = quality_of(core, packet);
  return fmt::format("RECVEND,{},{},{},{}", S2cCore::clock_us(SimTime::from_utime(packet.arrival_utime)),
                     q.duration_us, q.rssi, q.integrity);
}

std::string receive_failed(const S2cCore& core, const packet_outcome_t& loss) {
  const S2cQuality q = quality_of(core, loss);
  return fmt::format("RECVFAILED,{:.4f},{},{}", q.velocity_mps, q.rssi, q.integrity);
}

S2cPosition position_message(const S2cCore& core, const S2cFix& fix) {
  const EulerAngles attitude = attitude_of(core.port());
  const auto bearing = elementary::sin_cos(fix.bearing_rad),
             elevation = elementary::sin_cos(fix.elevation_rad);
  // Unit vector to the source in the head's frame (x to starboard, y forward, z up), with elevation e and
  // bearing b:
  //
  //   x = cos(e) sin(b),   y = cos(e) cos(b),   z = sin(e)
  //
  // The attitude rotates (y, x, -z) to north, east, down.
  const double x = elevation.cosine * bearing.sine, y = elevation.cosine * bearing.cosine, z = elevation.sine;
  const Vec3 ned = to_quaternion(attitude) * Vec3(y, x, -z);
  const double now_s = core.reading().seconds(), measured_s = fix.measured.seconds();
  const std::string head = fmt::format("{:.6f},{:.6f},{},", now_s, measured_s, fix.address);
  const std::string angles = fmt::format("{:.4f},{:.4f},{:.4f}", attitude.roll, attitude.pitch, attitude.yaw);
  if (!fix.has_range)
    return {fmt::format("USBLANGLES,{}{:.4f},{:.4f},{:.4f},{:.4f},{},{},{},{:.4f}", head, fix.bearing_rad,
                        fix.elevation_rad, elementary::atan2(ned.y(), ned.x()),
                        elementary::asin(std::clamp(-ned.z(), -1.0, 1.0)), angles, fix.rssi, fix.integrity,
                        fix.deviation_rad),
            ""};
  const double range_m = fix.travel_time_s * static_cast<double>(core.setting("!CA"));
  const std::string enu =
      fmt::format("{:.4f},{:.4f},{:.4f}", range_m * ned.y(), range_m * ned.x(), -range_m * ned.z());
  return {fmt::format("USBLLONG,{}{:.4f},{:.4f},{:.4f},{},{},{},{},{},{:.4f}", head, range_m * x, range_m * y,
                      range_m * z, enu, angles, microseconds(fix.travel_time_s), fix.rssi, fix.integrity,
                      range_m * fix.deviation_rad),
          fmt::format("{:.6f},{},{}", measured_s, fix.address, enu)};
}

}  // namespace halocline::modem_gateway
