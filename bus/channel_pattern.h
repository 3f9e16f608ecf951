// Whether a channel is matched by a subscription's expression, as LCM would have it: the whole channel, not a part.
//
// What Bus subscribes to, escaped channels and escaped prefixes before ".*", is compared as text; any other
// expression is one of std::regex (ECMAScript), which agrees with LCM's (GLib) in all that channels need.
#pragma once

#include <cstddef>
#include <optional>
#include <regex>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

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

// The expressions of all subscriptions.
class ChannelPatterns {
 public:
  // Throws as ChannelPattern.
  void add(const std::string& expression);
  // Whether one of them matches. Answers are kept: a heartbeat asks for each flow of its node.
  bool match(std::string_view channel);

 private:
  static constexpr std::size_t kMostKept = 100'000;

  std::vector<ChannelPattern> patterns_;
  std::unordered_map<std::string, bool> known_;
};

}  // namespace halocline::bus
