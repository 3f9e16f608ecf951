// SPDX-License-Identifier: BSD-3-Clause
#include "bus/messages/channel_pattern.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include <re2/re2.h>

#include "core/check.h"

namespace halocline::bus {
namespace {

// Memory limit of RE2 for an expression and the automaton that it builds while matching. A larger expression
// is refused; a match that needs more falls back to RE2's slower algorithm, whose time is of the same order.
constexpr std::int64_t kMaxExpressionBytes = 256 << 10;

constexpr std::string_view kSpecial = R"(\^$.|?*+()[]{})";

// Returns the text that an expression of escaped characters matches; nothing if it contains an operator.
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

struct ChannelPattern::Expression {
  explicit Expression(const std::string& text) : regex(text, options()) {}

  static re2::RE2::Options options() {
    re2::RE2::Options options;
    options.set_encoding(re2::RE2::Options::EncodingLatin1);  // one byte is one character
    options.set_max_mem(kMaxExpressionBytes);
    options.set_never_capture(true);
    options.set_log_errors(false);
    return options;
  }

  re2::RE2 regex;
};

ChannelPattern::ChannelPattern(const std::string& expression) {
  const std::string_view view = expression;
  is_prefix_ = view.ends_with(".*") && literal(view.substr(0, view.size() - 2)).has_value();
  if (auto text = literal(is_prefix_ ? view.substr(0, view.size() - 2) : view)) {
    text_ = std::move(*text);
    return;
  }
  expression_ = std::make_shared<const Expression>(expression);
  const re2::RE2& regex = expression_->regex;
  require(regex.ok(), "'" + expression + "' is no regular expression: " + regex.error());
}

bool ChannelPattern::matches(std::string_view channel) const {
  if (expression_) return re2::RE2::FullMatch({channel.data(), channel.size()}, expression_->regex);
  return is_prefix_ ? channel.starts_with(text_) : channel == text_;
}

void ChannelPatterns::add(const std::string& expression) {
  ChannelPattern pattern(expression);
  if (!pattern.only_channel().empty())
    of_one_channel_[std::string(pattern.only_channel())].push_back(size_);
  else
    others_.push_back({std::move(pattern), size_});
  ++size_;
}

std::vector<std::size_t> ChannelPatterns::matching(std::string_view channel) const {
  std::vector<std::size_t> places;
  const auto own = of_one_channel_.find(channel);
  if (own != of_one_channel_.end()) places = own->second;
  for (const Numbered& other : others_) {
    if (other.pattern.matches(channel)) places.push_back(other.place);
  }
  std::sort(places.begin(), places.end());
  return places;
}

std::string escaped(std::string_view channel) {
  constexpr std::string_view kSpecial = R"(\^$.|?*+()[]{})";
  std::string expression;
  for (const char c : channel) {
    if (kSpecial.find(c) != std::string_view::npos) expression += '\\';
    expression += c;
  }
  return expression;
}

}  // namespace halocline::bus
