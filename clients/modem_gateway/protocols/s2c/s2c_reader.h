// SPDX-License-Identifier: BSD-3-Clause
// Commands and data out of the bytes that a host writes to an EvoLogics modem, in any pieces.
//
// In command mode there are commands, ended by a carriage return, a line feed or both; those that send hold
// data of a stated length, which may contain anything. In data mode a command begins with +++AT, and all
// other bytes are data of the burst connection.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace halocline::modem_gateway {

struct S2cCommand {
  std::string name;        // with its sign and without parameters: *SENDIM, !AL, ?CLOCK, &V, I, Z
  std::string parameters;  // what follows it up to the end of the line: 12
  std::vector<std::string>
      fields;        // of a command that sends: protocol id, length, destination, ... before its data
  std::string data;  // of a command that sends
  bool is_well_formed = true;  // false: a line that is no command, or data of another length than stated
};

class S2cReader {
 public:
  // What came: a command, or data of the burst connection.
  struct Item {
    std::optional<S2cCommand> command;
    std::string data;
  };

  static constexpr std::size_t kMaxLine = 8192;

  bool is_data_mode() const { return is_data_mode_; }
  void set_data_mode(bool data_mode) { is_data_mode_ = data_mode; }

  void append(std::string_view bytes) { buffer_ += bytes; }
  // The next that is complete; none while there is none. A change of mode holds for what follows.
  std::optional<Item> take();
  // In data mode, what looked like the beginning of a command and went no further; it is data.
  std::string take_held();

 private:
  std::optional<Item> take_line(std::size_t begin);
  std::optional<Item> take_data();
  Item wrong(std::size_t size);

  std::string buffer_;
  bool is_data_mode_ = false;
  bool discards_line_ = false;  // the rest of one that was too long
};

// The name and the parameters of a line that begins with AT.
S2cCommand s2c_command(std::string_view line);

}  // namespace halocline::modem_gateway
