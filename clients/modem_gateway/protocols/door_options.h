// SPDX-License-Identifier: BSD-3-Clause
// The options of a door: "name=value name=value", as its protocol knows them.
//
//   DoorOptions options("revision=0.94.0.00");
//   const std::string revision = options.take("revision", "2.0.31000");
//   options.require_all_taken();
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace halocline::modem_gateway {

class DoorOptions {
 public:
  DoorOptions() = default;
  // Throws InvalidArgument for a text of another form.
  explicit DoorOptions(std::string_view text);

  // The value of an option, which the protocol knows; `otherwise` where it is not given.
  std::string take(const std::string& name, std::string_view otherwise);
  // The same of yes and no, and of a number. Throw InvalidArgument that names what is allowed.
  bool take_flag(const std::string& name, bool otherwise);
  double take_number(const std::string& name, double otherwise, double lowest, double highest);
  // Throws InvalidArgument for an option that nobody took, and lists those that were.
  void require_all_taken() const;

 private:
  std::map<std::string, std::string> given_;
  std::map<std::string, std::string> known_;  // with their values
};

}  // namespace halocline::modem_gateway
