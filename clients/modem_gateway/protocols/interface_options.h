// SPDX-License-Identifier: BSD-3-Clause
// Options of a modem interface, "name=value name=value", which its protocol reads one by one:
//
//   InterfaceOptions options("revision=0.94.0.00");
//   const std::string revision = options.take("revision", "2.0.31000");
//   options.require_all_taken();
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace halocline::modem_gateway {

class InterfaceOptions {
 public:
  InterfaceOptions() = default;
  // Parses the options. Throws InvalidArgument for a malformed text.
  explicit InterfaceOptions(std::string_view text);

  // Returns the value of an option and marks it as known; `otherwise` when it is not given.
  std::string take(const std::string& name, std::string_view otherwise);
  // Take the value of a yes/no option or of a number. They throw InvalidArgument, which names the allowed
  // values.
  bool take_flag(const std::string& name, bool otherwise);
  double take_number(const std::string& name, double otherwise, double lowest, double highest);
  // Throws InvalidArgument for a given option that was never taken; the message lists the known ones.
  void require_all_taken() const;

 private:
  std::map<std::string, std::string> given_;
  std::map<std::string, std::string> known_;  // options that were taken, with their values
};

}  // namespace halocline::modem_gateway
