// SPDX-License-Identifier: BSD-3-Clause
#include "python/log_arrays.h"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <type_traits>
#include <utility>

#include "bus/logs/channel_types.h"
#include "bus/messages/channel_family.h"
#include "bus/messages/channel_pattern.h"
#include "bus/messages/message_field.h"
#include "bus/messages/message_fields.h"
#include "core/check.h"

namespace halocline::clients {
namespace {

template <class T>
inline constexpr bool kIsBytes = std::is_same_v<T, LogColumn::Bytes>;

template <class T>
using Stored =
    std::conditional_t<std::is_floating_point_v<T>, double,
                       std::conditional_t<std::is_integral_v<T>, std::int64_t,
                                          std::conditional_t<kIsBytes<T>, LogColumn::Bytes, std::string>>>;

// Appends one message to a table; the first message creates the columns.
class RowAppender {
 public:
  explicit RowAppender(LogTable& table) : table_(table) {}

  template <class T>
  void operator()(const MessageField& field, const T& value) {
    inner_ = field.inner;
    append(prefix_ + std::string(field.name), value);
  }

  template <class T>
  void append(const std::string& name, const T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string> || kIsBytes<T>) {
      store<Stored<T>>(name, &value, 1, 1, false);
    } else if constexpr (std::is_array_v<T>) {
      store<Stored<std::remove_extent_t<T>>>(name, value, std::extent_v<T>, std::extent_v<T>, true);
    } else if constexpr (kIsList<T>) {
      append_list(name, value);
    } else {
      append_message(name, value);
    }
  }

  void end_row() {
    for (LogColumn& column : table_) {
      if (column.is_list)
        column.ends.push_back(std::visit([](const auto& values) { return values.size(); }, column.values));
    }
  }

 private:
  template <class Element>
  void append_list(const std::string& name, const std::vector<Element>& list) {
    const bool outer = std::exchange(in_list_, true);
    if constexpr (kIsList<Element>) {
      declare<Stored<typename Element::value_type>>(name, inner_, true);
      for (const Element& element : list)
        store<Stored<typename Element::value_type>>(name, element.data(), inner_, inner_, true);
    } else if constexpr (requires(Element e) { e.getEncodedSize(); }) {
      declare_fields<Element>(name);
      for (const Element& element : list) append_message(name, element);
    } else {
      declare<Stored<Element>>(name, 1, false);
      for (const Element& element : list) store<Stored<Element>>(name, &element, 1, 1, false);
    }
    in_list_ = outer;
  }

  template <class Message>
  void append_message(const std::string& name, const Message& message) {
    const std::string outer = std::exchange(prefix_, name + ".");
    visit_fields(*this, message);
    prefix_ = outer;
  }

  // Creates the columns of an empty list of messages, from a message that is not stored.
  template <class Message>
  void declare_fields(const std::string& name) {
    const bool outer = std::exchange(only_declares_, true);
    append_message(name, Message{});
    only_declares_ = outer;
  }

  template <class Value>
  LogColumn& declare(const std::string& name, std::size_t width, bool is_array) {
    // Fields arrive in the order of their columns, except for those of list elements, which repeat.
    if (next_ >= table_.size() || table_[next_].name != name) {
      const auto found =
          std::find_if(table_.begin(), table_.end(), [&](const LogColumn& c) { return c.name == name; });
      next_ = static_cast<std::size_t>(found - table_.begin());
    }
    if (next_ < table_.size()) return table_[next_++];
    table_.push_back({name, std::vector<Value>{}, width, is_array, in_list_, {}});
    next_ = table_.size();
    return table_.back();
  }

  template <class Value, class T>
  void store(const std::string& name, const T* first, std::size_t count, std::size_t width, bool is_array) {
    LogColumn& column = declare<Value>(name, width, is_array);
    if (only_declares_) return;
    auto& values = std::get<std::vector<Value>>(column.values);
    for (std::size_t i = 0; i < count; ++i) values.push_back(static_cast<Value>(first[i]));
  }

  LogTable& table_;
  std::string prefix_;
  std::size_t inner_ = 1, next_ = 0;
  bool in_list_ = false, only_declares_ = false;
};

std::string lower_case(std::string_view family) {
  std::string text(family);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// Visitor that finds one field of a message type, and lists the type's enumerations.
struct FieldFinder {
  std::string_view wanted;
  bool found = false;
  std::vector<std::string> names = {}, enumerations = {};

  template <class T>
  void operator()(const MessageField& field, const T&) {
    if (!field.enumeration.empty()) enumerations.emplace_back(field.name);
    if (field.name != wanted) return;
    found = true;
    names.assign(field.enumeration.begin(), field.enumeration.end());
  }
};

std::string list_of(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text.empty() ? "none" : text;
}

}  // namespace

LogTables read_tables(LogReader& log, const std::string& channel_pattern) {
  const bus::ChannelPattern wanted(channel_pattern.empty() ? ".*" : channel_pattern);
  LogTables tables;
  LoggedEvent event;
  while (log.next(event)) {
    if (!wanted.matches(event.channel)) continue;
    with_type_of(event.channel, [&]<class Message>() {
      Message message{};
      if (!decode_checked(event.data, message)) {
        ++tables.undecodable;
        return;
      }
      RowAppender row(tables.by_family[lower_case(family_of(without_repair(event.channel)))]);
      row.append("event", event.number);
      row.append("stamp_us", event.stamp_us);
      row.append("channel", event.channel);
      visit_fields(row, message);
      row.end_row();
    });
  }
  return tables;
}

std::vector<std::string> names_of(const std::string& family, const std::string& field) {
  FieldFinder finder{field};
  const bool exists = bus::any_channel([&]<class Message>(const auto& channel) {
    std::string_view name;
    if constexpr (std::is_same_v<std::decay_t<decltype(channel)>, bus::Family>) {
      name = channel.prefix;
    } else {
      name = channel;
    }
    if (lower_case(family_of(name)) != family) return false;
    visit_fields(finder, Message{});
    return true;
  });
  require(exists, "'" + family + "' is no channel family; families are the keys of what read_log returns");
  require(finder.found && !finder.names.empty(), "'" + field + "' is no enumeration of " + family +
                                                     "; enumerations are: " + list_of(finder.enumerations));
  return finder.names;
}

}  // namespace halocline::clients
