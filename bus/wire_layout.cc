#include "bus/wire_layout.h"

#include <cstdint>

namespace halocline::bus {
namespace {

constexpr std::size_t kFingerprintBytes = 8;

WireField fixed(std::size_t bytes) { return {WireField::Kind::kFixed, bytes, {}}; }
WireField text() { return {WireField::Kind::kString, 0, {}}; }
WireField count() { return {WireField::Kind::kCount, 0, {}}; }
WireField array_of(WireLayout element) { return {WireField::Kind::kArray, 0, std::move(element)}; }
WireField array_of_bytes(std::size_t bytes) { return array_of({fixed(bytes)}); }

void append(WireLayout& layout, const WireLayout& nested) {
  layout.insert(layout.end(), nested.begin(), nested.end());
}

class Walk {
 public:
  Walk(const void* data, std::size_t size) : bytes_(static_cast<const std::uint8_t*>(data)), left_(size) {}

  std::string over(const WireLayout& layout) {
    std::int64_t elements = 0;
    for (const WireField& field : layout) {
      const std::string problem = step(field, elements);
      if (!problem.empty()) return problem;
    }
    return "";
  }

  bool skip(std::size_t bytes) {
    if (bytes > left_) return false;
    bytes_ += bytes;
    left_ -= bytes;
    return true;
  }

  std::size_t left() const { return left_; }

 private:
  std::string step(const WireField& field, std::int64_t& elements) {
    switch (field.kind) {
      case WireField::Kind::kFixed:
        return skip(field.bytes) ? "" : "too short";
      case WireField::Kind::kString:
        return over_string();
      case WireField::Kind::kCount:
        return read_int32(elements) && elements >= 0 ? "" : "impossible array length";
      case WireField::Kind::kArray:
        return over_array(field.element, elements);
    }
    return "";
  }

  std::string over_string() {
    std::int64_t length = 0;
    if (!read_int32(length) || length < 1) return "impossible string length";
    if (static_cast<std::size_t>(length) > left_) return "string longer than the message";
    if (bytes_[length - 1] != 0) return "string without its end";
    skip(static_cast<std::size_t>(length));
    return "";
  }

  std::string over_array(const WireLayout& element, std::int64_t elements) {
    if (static_cast<std::uint64_t>(elements) > left_) return "array longer than the message";
    if (element.size() == 1 && element[0].kind == WireField::Kind::kFixed) {
      return skip(element[0].bytes * static_cast<std::size_t>(elements)) ? ""
                                                                         : "array longer than the message";
    }
    for (std::int64_t i = 0; i < elements; ++i) {
      const std::string problem = over(element);
      if (!problem.empty()) return problem;
    }
    return "";
  }

  bool read_int32(std::int64_t& value) {
    if (left_ < 4) return false;
    const std::uint32_t raw = std::uint32_t{bytes_[0]} << 24 | std::uint32_t{bytes_[1]} << 16 |
                              std::uint32_t{bytes_[2]} << 8 | std::uint32_t{bytes_[3]};
    value = static_cast<std::int32_t>(raw);
    return skip(4);
  }

  const std::uint8_t* bytes_;
  std::size_t left_;
};

// utime, session and sequence, the head of most messages.
constexpr std::size_t kHead = 3 * 8;

WireLayout modem_layout() {
  return {fixed(8 + 7 * 8 + 4 + 1 + 4 + 3 * 8 + 2), count(), array_of_bytes(8), array_of_bytes(8)};
}
WireLayout link_layout() { return {fixed(2 * 4 + 7 * 8 + 1 + 1 + 2 * 8 + 1 + 1 + 4 + 2 * 8)}; }
WireLayout packet_name_layout() { return {fixed(4 + 1 + 2 * 8)}; }

WireLayout link_end_layout() {
  WireLayout layout{text(), fixed(3 * 8 + 1)};
  append(layout, modem_layout());
  return layout;
}

WireLayout link_answer_layout() {
  WireLayout layout{fixed(1), text()};
  append(layout, link_layout());
  layout.push_back(fixed(3 * 8 + 1));
  return layout;
}

WireLayout lockstep_message_layout() { return {fixed(8), text(), count(), array_of_bytes(1)}; }

}  // namespace

std::string misfit(const WireLayout& layout, const void* data, std::size_t size) {
  Walk walk(data, size);
  if (!walk.skip(kFingerprintBytes)) return "too short";
  std::string problem = walk.over(layout);
  if (problem.empty() && walk.left() != 0) problem = "longer than its fields";
  return problem;
}

#define HALOCLINE_LAYOUT(type, ...)             \
  template <>                                   \
  const WireLayout& wire_layout<type>() {       \
    static const WireLayout layout __VA_ARGS__; \
    return layout;                              \
  }

HALOCLINE_LAYOUT(sim_clock_t, {fixed(kHead + 8 + 8 + 1)})
HALOCLINE_LAYOUT(vehicle_state_t, {fixed(kHead + 4 + (3 + 4 + 3 + 3) * 8)})
HALOCLINE_LAYOUT(vehicle_command_t, {fixed(kHead + (3 + 4) * 8)})
HALOCLINE_LAYOUT(vehicle_sensors_t, {fixed(kHead + 8 + 1 + 5 * 8 + 3 * 8 + (3 + 4) * 8 + 6)})
HALOCLINE_LAYOUT(vehicle_dvl_t, {fixed(kHead + 4 * (1 + 2 * 8) + 1 + 4 * 8)})
HALOCLINE_LAYOUT(vehicle_gps_t, {fixed(kHead + 3 * 8)})
HALOCLINE_LAYOUT(vehicle_sonar_t,
                 {fixed(kHead + 2 * 8), count(), array_of_bytes(8), array_of_bytes(1), array_of_bytes(8)})
HALOCLINE_LAYOUT(vehicle_usbl_t, {fixed(kHead + 4 + 1 + 2 * 8 + 3 * 8 + 1 + 8)})
HALOCLINE_LAYOUT(vehicle_fault_t, {fixed(kHead + 3 + 3 * 8 + 1)})
HALOCLINE_LAYOUT(current_change_t, {fixed(kHead + 3 * 8), count(), array_of_bytes(8), array_of_bytes(8),
                                    array_of_bytes(8), fixed(6 * 8)})
HALOCLINE_LAYOUT(environment_t,
                 {fixed(kHead), count(), array_of_bytes(8), array_of_bytes(8), array_of_bytes(8),
                  array_of_bytes(8), fixed(5 * 8), text(), text(), fixed(4 * 8), text(), text(), text()})
HALOCLINE_LAYOUT(environment_change_t, {fixed(kHead + 4 + 3 * 8), count(), array_of_bytes(8),
                                        array_of_bytes(8), array_of_bytes(8), array_of_bytes(8)})
HALOCLINE_LAYOUT(modem_config_t, (modem_layout()))
HALOCLINE_LAYOUT(modem_send_t, {fixed(kHead + 2 * 4 + 2), count(), array_of_bytes(1)})
HALOCLINE_LAYOUT(modem_receipt_t, {fixed(kHead + 2 * 8 + 1 + 8 + 8)})
HALOCLINE_LAYOUT(modem_receive_t, {fixed(kHead + 2 * 8 + 3 * 4 + 2 + 8 + 6 * 8), count(), array_of_bytes(1)})
HALOCLINE_LAYOUT(packet_name_t, (packet_name_layout()))
HALOCLINE_LAYOUT(packet_outcome_t, {fixed(kHead + 2 * 8 + 3 * 4 + 2 + 8 + 8 * 8 + 1 + 4 + 10 * 8), count(),
                                    array_of(packet_name_layout())})
HALOCLINE_LAYOUT(ping_answer_t, {fixed(kHead), text(), fixed(2 * 4 + 5 * 8)})
HALOCLINE_LAYOUT(position_estimate_t, {fixed(kHead + 4 + 1 + (3 + 9 + 3 + 1) * 8 + 2 * 8 + 1 + 3 * 8)})
HALOCLINE_LAYOUT(link_t, (link_layout()))
HALOCLINE_LAYOUT(link_table_t, {fixed(kHead + 4), count(), array_of(link_layout())})
HALOCLINE_LAYOUT(link_end_t, (link_end_layout()))
HALOCLINE_LAYOUT(link_query_t, {fixed(8), text(), fixed(8), count(), array_of(link_end_layout()),
                                array_of(link_end_layout())})
HALOCLINE_LAYOUT(link_answer_t, (link_answer_layout()))
HALOCLINE_LAYOUT(link_reply_t, {fixed(3 * 8 + 1), text(), count(), array_of(link_answer_layout())})
HALOCLINE_LAYOUT(ray_query_t, {fixed(8), text(), fixed(8), text(), fixed(1 + 8 + 3 * 8), count(),
                               array_of_bytes(3 * 8), array_of_bytes(3 * 8), array_of_bytes(8)})
HALOCLINE_LAYOUT(ray_reply_t,
                 {fixed(3 * 8), text(), fixed(1), text(), count(), array_of_bytes(1), array_of_bytes(8),
                  count(), array_of_bytes(8), array_of_bytes(8), array_of_bytes(1)})
HALOCLINE_LAYOUT(node_status_t, {fixed(kHead), text(), text(), fixed(8 * 8), text()})
HALOCLINE_LAYOUT(flow_heartbeat_t,
                 {fixed(kHead + 8), count(), array_of({text()}), array_of_bytes(8), array_of_bytes(8)})
HALOCLINE_LAYOUT(repair_request_t, {fixed(8), text(), text(), fixed(8), count(), array_of_bytes(8)})

HALOCLINE_LAYOUT(lockstep_message_t, (lockstep_message_layout()))
HALOCLINE_LAYOUT(lockstep_turn_t, {fixed(2 * 8 + 4 + 1), count(), array_of({text()}), count(),
                                   array_of(lockstep_message_layout())})
HALOCLINE_LAYOUT(lockstep_result_t, {text(), fixed(4 + 3 * 8), count(), array_of(lockstep_message_layout())})
HALOCLINE_LAYOUT(lockstep_grant_t, {fixed(8), count(), array_of_bytes(8), array_of_bytes(8),
                                    fixed(4 + 1 + 2 * 4), count(), array_of_bytes(1)})
HALOCLINE_LAYOUT(lockstep_answer_t, {fixed(3 * 8 + 1 + 2 * 4), count(), array_of_bytes(1)})
HALOCLINE_LAYOUT(lockstep_join_t, {fixed(2 * 8), text(), text(), fixed(4 + 2 * 8 + 1), count(),
                                   array_of({text()}), array_of_bytes(1)})
HALOCLINE_LAYOUT(lockstep_notice_t, {fixed(2 * 8 + 1), text()})

#undef HALOCLINE_LAYOUT

}  // namespace halocline::bus
