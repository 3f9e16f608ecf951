// Whether a channel is matched by a subscription's expression, as LCM would have it: the whole channel, not a part.
//
// What Bus subscribes to, escaped channels and escaped prefixes before ".*", is compared as text; any other
// expression is one of std::regex (ECMAScript), which agrees with LCM's (GLib) in all that channels need.
#pragma once

#include <optional>
#include <regex>
#include <string>
#include <string_view>

namespace halocline::bus {

class ChannelPattern {
 public:
  // Throws InvalidArgument for what is no regular expression.
  explicit ChannelPattern(const std::string& expression);
  bool matches(std::string_view channel) const;

 private:
  std::string text_;     // the channel, or what it begins with
  bool prefix_ = false;  // text_ is what it begins with
  std::optional<std::regex> regex_;
};

}  // namespace halocline::bus
