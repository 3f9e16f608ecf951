// SPDX-License-Identifier: BSD-3-Clause
// Matches channels against a subscription's expression as LCM does: the whole channel must match, not a part.
//
// The expressions of Bus (escaped channels, and escaped prefixes followed by ".*") are compared as text. Any
// other expression is handled by RE2, which agrees with LCM's engine (GLib) in everything that channels need,
// but has neither look-around nor back-references. The time of a match is at most proportional to the length
// of the expression times that of the channel, so an expression from a foreign process (JOIN) cannot stall a
// node.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace halocline::bus {

// Returns the regular expression of LCM that matches exactly this channel.
std::string escaped(std::string_view channel);

class ChannelPattern {
 public:
  // Throws InvalidArgument for an invalid regular expression.
  explicit ChannelPattern(const std::string& expression);
  bool matches(std::string_view channel) const;
  // Returns the only channel that the pattern matches; empty if it may match several.
  std::string_view only_channel() const { return is_prefix_ || expression_ ? "" : std::string_view(text_); }
  // Returns the prefix, if the pattern matches exactly the channels that begin with it; empty otherwise.
  std::string_view only_prefix() const { return is_prefix_ ? std::string_view(text_) : ""; }

 private:
  std::string text_;        // the channel or the prefix
  bool is_prefix_ = false;  // text_ is a prefix
  struct Expression;        // wraps RE2; keeps its header out of this one, which all nodes include
  std::shared_ptr<const Expression> expression_;  // null if text_ suffices
};

// Patterns of many subscriptions, most of which match one channel only.
class ChannelPatterns {
 public:
  // Throws as ChannelPattern does.
  void add(const std::string& expression);
  // Returns the indices, in the order of add(), of the patterns that match; ascending.
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
