#include "bus/channel_pattern.h"

#include <algorithm>
#include <utility>

#include "core/check.h"

namespace halocline::bus {
namespace {

constexpr std::string_view kSpecial = R"(\^$.|?*+()[]{})";

// The text that an expression of escaped characters matches; empty when it holds anything else.
std::optional<std::string> literal(std::string_view expression) {
  std::string text;
  for (std::size_t i = 0; i < expression.size(); ++i) {
    const bool special = kSpecial.find(expression[i]) != std::string_view::npos;
    if (special && expression[i] != '\\') return std::nullopt;
    if (special && (++i == expression.size() || kSpecial.find(expression[i]) == std::string_view::npos))
      return std::nullopt;
    text += expression[i];
  }
  return text;
}

}  // namespace

ChannelPattern::ChannelPattern(const std::string& expression) {
  const std::string_view view = expression;
  prefix_ = view.ends_with(".*") && literal(view.substr(0, view.size() - 2)).has_value();
  if (auto text = literal(prefix_ ? view.substr(0, view.size() - 2) : view)) {
    text_ = std::move(*text);
    return;
  }
  try {
    regex_.emplace(expression, std::regex::ECMAScript | std::regex::optimize);
  } catch (const std::regex_error& error) {
    throw InvalidArgument("'" + expression + "' is no regular expression: " + error.what());
  }
}

bool ChannelPattern::matches(std::string_view channel) const {
  if (regex_) return std::regex_match(channel.begin(), channel.end(), *regex_);
  return prefix_ ? channel.starts_with(text_) : channel == text_;
}

void ChannelPatterns::add(const std::string& expression) {
  patterns_.emplace_back(expression);
  known_.clear();
}

bool ChannelPatterns::match(std::string_view channel) {
  if (known_.size() >= kMostKept) known_.clear();
  const auto [known, is_new] = known_.try_emplace(std::string(channel));
  if (is_new) {
    known->second = std::any_of(patterns_.begin(), patterns_.end(),
                                [&](const ChannelPattern& pattern) { return pattern.matches(channel); });
  }
  return known->second;
}

}  // namespace halocline::bus
