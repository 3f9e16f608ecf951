// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/interface_options.h"

#include "clients/modem_gateway/protocols/fields.h"
#include "core/check.h"

namespace halocline::modem_gateway {

InterfaceOptions::InterfaceOptions(std::string_view text) {
  for (const std::string_view word : words_of(text)) {
    const auto equals = word.find('=');
    require(equals != std::string_view::npos && equals > 0,
            "'" + std::string(word) + "' is no option; allowed is name=value, with blanks between options");
    given_[std::string(word.substr(0, equals))] = std::string(word.substr(equals + 1));
  }
}

std::string InterfaceOptions::take(const std::string& name, std::string_view otherwise) {
  const auto found = given_.find(name);
  return known_[name] = found == given_.end() ? std::string(otherwise) : found->second;
}

bool InterfaceOptions::take_flag(const std::string& name, bool otherwise) {
  const std::string value = take(name, otherwise ? "yes" : "no");
  require(value == "yes" || value == "no", "option " + name + " is '" + value + "'; allowed are yes and no");
  return value == "yes";
}

double InterfaceOptions::take_number(const std::string& name, double otherwise, double lowest,
                                     double highest) {
  const std::string text = take(name, "");
  if (text.empty()) return otherwise;
  const auto value = number_in(text, lowest, highest);
  require(value.has_value(), "option " + name + " is '" + text + "'; allowed is a number from " +
                                 std::to_string(lowest) + " to " + std::to_string(highest));
  return *value;
}

void InterfaceOptions::require_all_taken() const {
  std::string known;
  for (const auto& [name, value] : known_) known += (known.empty() ? "" : ", ") + name;
  for (const auto& [name, value] : given_) {
    require(known_.contains(name),
            "option '" + name + "' is unknown; " +
                (known.empty() ? "this kind of modem interface has none" : "allowed are " + known));
  }
}

}  // namespace halocline::modem_gateway
