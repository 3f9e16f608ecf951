// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/s2c/s2c_reader.h"

#include <algorithm>
#include <array>
#include <utility>

#include "clients/modem_gateway/protocols/fields.h"

namespace halocline::modem_gateway {
namespace {

constexpr std::string_view kEscape = "+++AT", kSend = "AT*SEND", kEnds = "\r\n", kSigns = "*!?&@";
constexpr std::int64_t kMaxData = 1024;

// Number of fields before the data of a command that sends: length, destination and, for some, one more.
struct SendShape {
  std::string_view name;
  std::size_t num_fields;
};
constexpr std::array<SendShape, 4> kSendShapes{
    {{"AT*SENDIM", 3}, {"AT*SENDIMS", 3}, {"AT*SENDPBM", 2}, {"AT*SEND", 2}}};

bool is_letter(char c) { return c >= 'A' && c <= 'Z'; }

// Head of a command that sends, that is everything before its data.
struct SendHead {
  std::vector<std::string> fields;
  std::size_t size = 0;  // bytes before the data
  std::size_t data_bytes = 0;
};
enum class HeadState { kNone, kIncomplete, kComplete };

HeadState read_head(std::string_view text, SendHead& head) {
  const std::string_view line = text.substr(0, text.find_first_of(kEnds));
  const bool has_end = line.size() < text.size();
  if (!line.starts_with(kSend)) return HeadState::kNone;
  const auto fields = fields_of(line, ',');
  const auto shape = std::find_if(kSendShapes.begin(), kSendShapes.end(),
                                  [&](const SendShape& s) { return s.name == fields.front(); });
  const HeadState unless_more = has_end ? HeadState::kNone : HeadState::kIncomplete;
  if (fields.size() < 2) return unless_more;
  if (shape == kSendShapes.end()) return HeadState::kNone;
  const std::size_t count = shape->num_fields + (fields[1].starts_with('p') ? 1 : 0);
  if (fields.size() < count + 2) return unless_more;
  head.size = fields[0].size() + 1;
  for (std::size_t i = 1; i <= count; ++i) {
    head.fields.emplace_back(fields[i]);
    head.size += fields[i].size() + 1;
  }
  const auto bytes = integer_in(head.fields[count - shape->num_fields], 0, kMaxData);
  head.data_bytes = static_cast<std::size_t>(bytes.value_or(0));
  return bytes ? HeadState::kComplete : HeadState::kNone;
}

}  // namespace

S2cCommand s2c_command(std::string_view line) {
  S2cCommand command;
  command.is_well_formed = line.starts_with("AT");
  if (!command.is_well_formed) return command;
  std::string_view rest = line.substr(2);
  std::size_t size = !rest.empty() && kSigns.find(rest[0]) != std::string_view::npos ? 1 : 0;
  while (size < rest.size() && is_letter(rest[size])) ++size;
  command.name = rest.substr(0, size);
  command.parameters = rest.substr(size);
  return command;
}

std::optional<S2cReader::Item> S2cReader::take() {
  if (is_data_mode_) return take_data();
  buffer_.erase(0, buffer_.find_first_not_of(kEnds));
  return take_line(0);
}

// Takes a command or a line of data mode. `begin` is the offset of the command: 3 in data mode, after +++.
std::optional<S2cReader::Item> S2cReader::take_line(std::size_t begin) {
  const std::string_view text = std::string_view(buffer_).substr(begin);
  const std::size_t end = std::min(text.find_first_of(kEnds), text.size());
  if (discards_line_) {
    discards_line_ = end == text.size();
    buffer_.erase(0, begin + end);
    return discards_line_ ? std::nullopt : take();
  }
  SendHead head;
  const HeadState state = read_head(text, head);
  if (state == HeadState::kComplete) {
    const std::size_t size = head.size + head.data_bytes;
    if (text.size() <= size) return std::nullopt;
    if (kEnds.find(text[size]) == std::string_view::npos) return wrong(begin + size);
    S2cCommand command = s2c_command(text.substr(0, head.size - 1));
    command.fields = std::move(head.fields);
    command.data = text.substr(head.size, head.data_bytes);
    buffer_.erase(0, begin + size + 1);
    return Item{std::move(command), {}};
  }
  if (end == text.size()) {
    if (text.size() <= kMaxLine) return std::nullopt;
    discards_line_ = true;
    buffer_.clear();
    return Item{S2cCommand{{}, {}, {}, {}, false}, {}};
  }
  Item item{s2c_command(text.substr(0, end)), {}};
  if (text.starts_with(kSend)) item.command->is_well_formed = false;  // incomplete head
  buffer_.erase(0, begin + end + 1);
  return item;
}

// Reports a malformed command and skips to the end of the line that contains byte `size`.
S2cReader::Item S2cReader::wrong(std::size_t size) {
  S2cCommand command = s2c_command(std::string_view(buffer_).substr(buffer_.find("AT")));
  command.is_well_formed = false;
  const std::size_t end = buffer_.find_first_of(kEnds, size);
  discards_line_ = end == std::string::npos;
  buffer_.erase(0, end);
  return Item{std::move(command), {}};
}

std::optional<S2cReader::Item> S2cReader::take_data() {
  if (buffer_.starts_with(kEscape)) return take_line(3);
  if (discards_line_) return take_line(0);
  std::size_t size = buffer_.find(kEscape);
  if (size == std::string::npos) {
    // The end may be an incomplete +++AT; it is kept until more arrives.
    size = buffer_.size();
    for (std::size_t held = std::min(kEscape.size() - 1, size); held > 0; --held) {
      if (!buffer_.ends_with(kEscape.substr(0, held))) continue;
      size -= held;
      break;
    }
  }
  if (size == 0) return std::nullopt;
  Item item{std::nullopt, buffer_.substr(0, size)};
  buffer_.erase(0, size);
  return item;
}

std::string S2cReader::take_held() {
  const bool is_command = buffer_.starts_with(kEscape);
  return is_data_mode_ && !is_command ? std::exchange(buffer_, "") : "";
}

}  // namespace halocline::modem_gateway
