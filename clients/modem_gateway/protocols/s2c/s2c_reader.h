// SPDX-License-Identifier: BSD-3-Clause
// Reader of an EvoLogics modem: splits the bytes of a host, in arbitrary pieces, into commands and data.
//
// In command mode everything is a command, which ends at a carriage return, a line feed or both. Commands
// that send contain data of a stated length, which may be any bytes. In data mode a command begins with
// +++AT, and all other bytes are data of the burst connection.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace halocline::modem_gateway {

struct S2cCommand {
  std::string name;        // name with its sign, without parameters: *SENDIM, !AL, ?CLOCK, &V, I, Z
  std::string parameters;  // text after the name, up to the end of the line: 12
  std::vector<std::string>
      fields;        // fields of a command that sends, before its data: protocol id, length, destination, ...
  std::string data;  // data of a command that sends
  bool is_well_formed = true;  // false: the line is not a command, or the data has another length than stated
};

class S2cReader {
 public:
  // One command, or data of the burst connection.
  struct Item {
    std::optional<S2cCommand> command;
    std::string data;
  };

  static constexpr std::size_t kMaxLine = 8192;

  bool is_data_mode() const { return is_data_mode_; }
  void set_data_mode(bool data_mode) { is_data_mode_ = data_mode; }

  void append(std::string_view bytes) { buffer_ += bytes; }
  // Takes the next complete item, if any. A change of mode applies to the bytes after it.
  std::optional<Item> take();
  // Takes, in data mode, bytes that looked like the beginning of a command but were not continued; they are
  // data.
  std::string take_held();

 private:
  std::optional<Item> take_line(std::size_t begin);
  std::optional<Item> take_data();
  Item wrong(std::size_t size);

  std::string buffer_;
  bool is_data_mode_ = false;
  bool discards_line_ = false;  // skips the rest of a line that was too long
};

// Splits a line that begins with AT into name and parameters.
S2cCommand s2c_command(std::string_view line);

}  // namespace halocline::modem_gateway
