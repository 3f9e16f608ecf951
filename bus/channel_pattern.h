// SPDX-License-Identifier: BSD-3-Clause
// Whether a channel is matched by a subscription's expression, as LCM would have it: the whole channel, not a
// part.
//
// What Bus subscribes to, escaped channels and escaped prefixes before ".*", is compared as text; any other
// expression is one of RE2, which agrees with LCM's (GLib) in all that channels need, but has neither
// look-around nor back-references. Whatever the expression, the time of a match is at most its length times
// the channel's: one of a stranger (JOIN) cannot stop a process.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace halocline::bus {

// A channel as a regular expression of LCM.
std::string escaped(std::string_view channel);

class ChannelPattern {
 public:
  // Throws InvalidArgument for what is no regular expression.
  explicit ChannelPattern(const std::string& expression);
  bool matches(std::string_view channel) const;
  // The one channel that it matches; empty where there are more.
  std::string_view only_channel() const { return is_prefix_ || expression_ ? "" : std::string_view(text_); }
  // What all channels that it matches begin with, and no others; empty where there is no such text.
  std::string_view only_prefix() const { return is_prefix_ ? std::string_view(text_) : ""; }

 private:
  std::string text_;        // the channel, or what it begins with
  bool is_prefix_ = false;  // text_ is what it begins with
  struct Expression;        // of RE2, whose header is left out of what all nodes include
  std::shared_ptr<const Expression> expression_;  // where it is no text
};

// The expressions of many subscriptions, most of them to one channel.
class ChannelPatterns {
 public:
  // Throws as ChannelPattern.
  void add(const std::string& expression);
  // The places, as they were added, of those that match: rising.
  std::vector<std::size_t> matching(std::string_view channel) const;

 private:
  struct Numbered {
    ChannelPattern pattern;
    std::size_t place;
  };
  std::size_t size_ = 0;
  std::map<std::string, std::vector<std::size_t>, std::less<>> of_one_channel_;
  std::vector<Numbered> others_;
};

}  // namespace halocline::bus
