// SPDX-License-Identifier: BSD-3-Clause
#include "bus/messages/message_checks.h"

#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <sstream>
#include <type_traits>
#include <vector>

#include "bus/messages/message_field.h"
#include "bus/messages/message_fields.h"
#include "core/names.h"

namespace halocline::bus {
namespace {

std::string range_problem(const MessageField& field, double value) {
  std::ostringstream text;
  text << field.name;
  if (!std::isfinite(value)) {
    text << " is not a finite number";
  } else if (!field.enumeration.empty()) {
    text << " is no value of its enumeration";
  } else if (!std::isfinite(field.max)) {
    text << " is " << value << "; allowed is " << field.min << " and up";
  } else {
    text << " is " << value << "; allowed is " << field.min << " to " << field.max;
  }
  return text.str();
}

// Finds the first problem in the fields that it visits.
class FieldChecker {
 public:
  template <class T>
  void operator()(const MessageField& field, const T& value) {
    if (problem.empty() && !field.is_unchecked) check(field, value);
  }

  std::string problem;

 private:
  template <class T>
  void check(const MessageField& field, const T& value) {
    if constexpr (std::is_arithmetic_v<T>) {
      check_number(field, static_cast<double>(value));
    } else if constexpr (std::is_same_v<T, std::string>) {
      check_text(field, value);
    } else if constexpr (std::is_array_v<T> || kIsList<T>) {
      check_list(field, value);
    } else if (const std::string inside = problem_in(value); !inside.empty()) {
      problem = std::string(field.name) + " " + inside;
    }
  }

  void check_number(const MessageField& field, double value) {
    if (problem.empty() && !(std::isfinite(value) && value >= field.min && value <= field.max)) {
      problem = range_problem(field, value);
    }
  }

  void check_text(const MessageField& field, const std::string& value) {
    const auto length = static_cast<double>(value.size());
    if (field.is_name && !is_valid_name(value)) {
      problem = std::string(field.name) + " is no name: " + std::string(kNameRule);
    } else if (!is_one_line(value)) {
      problem = std::string(field.name) + " is not " + std::string(kLineRule);
    } else if (length < field.min || length > field.max) {
      problem = "the length of " + range_problem(field, length);
    }
  }

  template <class List>
  void check_list(const MessageField& field, const List& list) {
    using Element = std::remove_cvref_t<decltype(*std::begin(list))>;
    if (std::is_integral_v<Element> && std::isinf(field.min)) return;
    for (auto element = std::begin(list); element != std::end(list) && problem.empty(); ++element) {
      check(field, *element);
      if constexpr (std::is_arithmetic_v<Element>) {
        if (field.is_ascending && element != std::begin(list) && problem.empty() &&
            !(*element > *std::prev(element))) {
          problem = std::string(field.name) + " does not ascend";
        }
      }
    }
  }
};

// Without a list of frames the modem divides the payload itself.
std::string problem_of_frames(const std::vector<std::int32_t>& frame_bytes, std::int32_t payload_size) {
  const std::int64_t sum = std::accumulate(frame_bytes.begin(), frame_bytes.end(), std::int64_t{0});
  return frame_bytes.empty() || sum == payload_size ? "" : "frame_bytes together are not payload_size";
}

template <class Slice>
std::string problem_of_slice(const Slice& m) {
  return m.slice_number < m.slice_count ? "" : "slice_number is not below slice_count";
}

}  // namespace

template <class Message>
std::string problem_in(const Message& message) {
  FieldChecker checker;
  visit_fields(checker, message);
  return checker.problem.empty() ? problem_between_fields(message) : checker.problem;
}

#define HALOCLINE_PROBLEM_IN(type) template std::string problem_in(const type&);
HALOCLINE_EACH_MESSAGE(HALOCLINE_PROBLEM_IN)
#undef HALOCLINE_PROBLEM_IN

std::string problem_between_fields(const vehicle_state_t& m) {
  constexpr double kTolerance = 1e-3;  // publishers in single precision stay well within
  double square = 0;
  for (const double q : m.orientation_wxyz) square += q * q;
  return std::abs(std::sqrt(square) - 1) <= kTolerance ? "" : "orientation_wxyz is no unit quaternion";
}

std::string problem_between_fields(const environment_change_t& m) {
  if (m.session == 0) return "session is 0, which is the scenario's";
  const bool sets_profile = m.profile_set != environment_change_t::PROFILE_UNCHANGED;
  return sets_profile && m.num_layers == 0 ? "num_layers is 0 although a profile is set" : "";
}

std::string problem_between_fields(const link_search_t& m) {
  double last_s = 0;
  for (const eigenray_t& path : m.eigenrays) {
    if (path.delay_s < last_s) return "eigenrays are not in the order of their delays";
    last_s = path.delay_s;
    constexpr double kMinMps = 500, kMaxMps = 5000;  // a third and three times the speed in water
    const double speed_mps = path.path_length_m / path.delay_s;
    if (speed_mps < kMinMps || speed_mps > kMaxMps) return "delay_s does not fit path_length_m";
    if (!(path.amplitude > 0)) return "amplitude is 0";
  }
  return "";
}

std::string problem_between_fields(const modem_config_t& m) {
  return m.bandwidth_hz < 2 * m.center_frequency_hz ? "" : "bandwidth_hz reaches below 0 Hz";
}

std::string problem_between_fields(const modem_send_t& m) {
  const bool is_ping = m.packet_kind == modem_send_t::PING;
  if (m.packet_kind == modem_send_t::PING_REPLY || m.packet_kind == modem_send_t::ACK)
    return "packet_kind is one that modems make by themselves";
  if (m.wants_ack != 0 && m.destination_id == kBroadcastId)
    return "destination_id is 0 for all; wants_ack goes to one vehicle";
  if (m.wants_ack != 0 && is_ping) return "wants_ack is 1 of a PING, which is answered by a PING_REPLY";
  if (m.num_frames > 0 && m.packet_kind != modem_send_t::DATA) return "num_frames is above 0; of DATA alone";
  return problem_of_frames(m.frame_bytes, m.payload_size);
}

std::string problem_between_fields(const modem_receive_t& m) {
  return problem_of_frames(m.frame_bytes, m.payload_size);
}

std::string problem_between_fields(const scenario_info_t& m) {
  return m.part_number < m.part_count ? "" : "part_number is not below part_count";
}

std::string problem_between_fields(const terrain_tile_t& m) {
  const std::int64_t posts = std::int64_t{m.tile_rows} * m.tile_columns;
  return m.num_posts == posts ? "" : "num_posts is not tile_rows times tile_columns";
}

// The content of slices is checked when they are complete (lockstep_wire.h).
std::string problem_between_fields(const lockstep_grant_t& m) { return problem_of_slice(m); }
std::string problem_between_fields(const lockstep_answer_t& m) { return problem_of_slice(m); }

std::string problem_between_fields(const lockstep_join_t& m) {
  return m.incarnation != 0 ? "" : "incarnation is 0";
}

}  // namespace halocline::bus
