// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bus/messages_for_tests.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string>
#include <type_traits>
#include <vector>

#include "bus/messages/message_field.h"
#include "bus/messages/message_fields.h"

namespace halocline::bus::testing {
namespace {

// Fills fields with small numbers within their limits that differ from field to field, so that an exchange of
// two shows.
class Filler {
 public:
  explicit Filler(unsigned seed) : seed_(seed), next_(seed * 7u % 50u) {}

  template <class T>
  void operator()(const MessageField& field, T& value) {
    if (field.is_count) {
      length_ = std::clamp(static_cast<double>(seed_ * 5u % 23u), std::max(0.0, field.min), field.max);
      if constexpr (std::is_arithmetic_v<T>) value = static_cast<T>(length_);
    } else {
      fill(field, value);
    }
  }

 private:
  template <class T>
  void fill(const MessageField& field, T& value) {
    if constexpr (std::is_integral_v<T>) {
      value = static_cast<T>(whole(field, std::is_same_v<T, std::int8_t>));
    } else if constexpr (std::is_arithmetic_v<T>) {
      value = static_cast<T>(real(field));
    } else if constexpr (std::is_same_v<T, std::string>) {
      const std::size_t shortest = field.is_name || field.min == 1 ? 1 : 0;
      value = std::string(shortest + seed_ % 7u, static_cast<char>('a' + draw() % 26));
    } else if constexpr (std::is_array_v<T> || kIsList<T>) {
      if constexpr (kIsList<T>) value.resize(static_cast<std::size_t>(length_));
      fill_list(field, value);
    } else {
      value = valid_message<T>(seed_ + draw());
    }
  }

  template <class List>
  void fill_list(const MessageField& field, List& list) {
    for (auto element = std::begin(list); element != std::end(list); ++element) {
      if constexpr (kIsList<std::remove_cvref_t<decltype(*element)>>) element->resize(field.inner);
      fill(field, *element);
    }
    if constexpr (std::is_same_v<List, std::vector<double>>) {
      if (!field.is_ascending) return;
      const double step = (field.max - field.min) / 64;
      for (std::size_t i = 0; i < list.size(); ++i) list[i] = field.min + step * static_cast<double>(i);
    }
  }

  // 1 to 90, or as far between the limits; of one byte an enumeration or a truth value.
  double whole(const MessageField& field, bool is_byte) {
    const bool is_truth = is_byte && field.enumeration.empty();
    const double lowest = std::max(field.min, 0.0), highest = is_truth ? 1 : std::min(field.max, 90.0);
    return lowest + std::fmod(draw(), highest - lowest + 1);
  }
  // 1.25 to 90.25, or as far between the limits.
  double real(const MessageField& field) {
    const double value = draw() + 0.25;
    const bool fits = value >= field.min && value <= field.max;
    return fits ? value : field.min + (field.max - field.min) * value / 91;
  }

  unsigned draw() { return ++next_ % 90u + 1; }

  unsigned seed_, next_;
  double length_ = 0;  // of the lists to come
};

// What no field states alone.
template <class Message>
void relate(Message&) {}
void relate(vehicle_state_t& m) {
  const double unit[4] = {0.5, -0.5, 0.5, -0.5};
  std::copy(unit, unit + 4, m.orientation_wxyz);
}
void relate(environment_change_t& m) {
  m.profile_set =
      m.num_layers > 0 ? environment_change_t::PROFILE_WATER : environment_change_t::PROFILE_UNCHANGED;
}
void relate(modem_config_t& m) {
  m.center_frequency_hz = 25'000;
  m.bandwidth_hz = 5'000;
}
template <class Message>
void set_frames(Message& m) {
  m.num_frames = m.payload_size > 0 ? 2 : 1;
  m.frame_bytes = {m.payload_size};
  if (m.num_frames == 2) m.frame_bytes = {1, m.payload_size - 1};
}
void relate(modem_send_t& m) {
  m.packet_kind = modem_send_t::DATA;
  m.destination_id = std::max(m.destination_id, 1);
  set_frames(m);
}
void relate(modem_receive_t& m) { set_frames(m); }
void relate(eigenray_t& m) { m.path_length_m = 1500 * m.delay_s; }
void relate(link_search_t& m) {
  std::sort(m.eigenrays.begin(), m.eigenrays.end(),
            [](const eigenray_t& a, const eigenray_t& b) { return a.delay_s < b.delay_s; });
}
void relate(scenario_info_t& m) { m.part_count = m.part_number + 1; }
void relate(terrain_tile_t& m) {
  m.tile_rows = 1;
  m.tile_columns = m.num_posts;
}
void relate(lockstep_grant_t& m) { m.slice_count = m.slice_number + 1; }
void relate(lockstep_answer_t& m) { m.slice_count = m.slice_number + 1; }

}  // namespace

template <class Message>
Message valid_message(unsigned seed) {
  Message message{};
  Filler filler(seed);
  visit_fields(filler, message);
  relate(message);
  return message;
}

#define HALOCLINE_VALID_MESSAGE(type) template type valid_message(unsigned);
HALOCLINE_EACH_MESSAGE(HALOCLINE_VALID_MESSAGE)
#undef HALOCLINE_VALID_MESSAGE

}  // namespace halocline::bus::testing
