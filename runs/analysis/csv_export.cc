// SPDX-License-Identifier: BSD-3-Clause
#include "runs/analysis/csv_export.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "bus/logs/channel_types.h"
#include "bus/messages/channel_family.h"
#include "bus/messages/channel_pattern.h"
#include "bus/messages/message_field.h"
#include "bus/messages/message_fields.h"
#include "core/atomic_file.h"
#include "core/check.h"
#include "core/csv_table.h"

namespace halocline::clients {
namespace {

template <class T>
inline constexpr bool kIsBytes = std::is_same_v<T, std::vector<std::uint8_t>>;

// Counts the rows that a message needs: the length of its longest list, or of a list in a nested message; at
// least one.
struct RowCounter {
  std::size_t rows = 1;
  template <class T>
  void operator()(const MessageField&, const T& value) {
    if constexpr (kIsList<T> && !kIsBytes<T>) {
      rows = std::max(rows, value.size());
    } else if constexpr (requires { value.getEncodedSize(); }) {
      visit_fields(*this, value);
    }
  }
};

template <class Number>
std::string number_text(Number value) {
  char text[40];
  if constexpr (std::is_integral_v<Number> && sizeof(Number) == 1) {
    return std::to_string(static_cast<int>(value));
  } else {
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    return std::string(text, end);
  }
}

std::string hexadecimal(const std::vector<std::uint8_t>& bytes) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string out;
  for (const std::uint8_t byte : bytes) out += {kDigits[byte >> 4], kDigits[byte & 15]};
  return out;
}

// Writes one row of a message, or the names of its columns.
class RowWriter {
 public:
  enum class What { kNames, kValues };
  RowWriter(std::string& line, What what, std::size_t row) : line_(line), what_(what), row_(row) {}

  template <class T>
  void operator()(const MessageField& field, const T& value) {
    inner_ = field.inner;
    write(prefix_ + std::string(field.name), value);
  }

 private:
  template <class T>
  void write(const std::string& name, const T& value) {
    if constexpr (std::is_arithmetic_v<T>) {
      cell(name, [&] { return number_text(value); });
    } else if constexpr (std::is_same_v<T, std::string>) {
      cell(name, [&] { return csv_cell(value); });
    } else if constexpr (kIsBytes<T>) {
      cell(name, [&] { return hexadecimal(value); });
    } else if constexpr (std::is_array_v<T>) {
      for (std::size_t i = 0; i < std::extent_v<T>; ++i) write(name + "_" + std::to_string(i), value[i]);
    } else if constexpr (kIsList<T>) {
      write_element(name, value);
    } else {
      const std::string outer = std::exchange(prefix_, name + ".");
      visit_fields(*this, value);
      prefix_ = outer;
    }
  }

  // Writes the element of this row; cells are empty when the list is shorter.
  template <class Element>
  void write_element(const std::string& name, const std::vector<Element>& list) {
    const bool ended = row_ >= list.size();
    const bool outer_blank = std::exchange(blank_, blank_ || ended);
    if constexpr (kIsList<Element>) {
      for (std::size_t i = 0; i < inner_; ++i)
        write(name + "_" + std::to_string(i), ended ? 0.0 : list[row_].at(i));
    } else {
      write(name, ended ? Element{} : list[row_]);
    }
    blank_ = outer_blank;
  }

  template <class Text>
  void cell(const std::string& name, const Text& text) {
    line_ += ",";
    if (what_ == What::kNames) {
      line_ += name;
    } else if (!blank_) {
      line_ += text();
    }
  }

  std::string& line_;
  What what_;
  std::size_t row_;
  std::string prefix_;
  std::size_t inner_ = 1;  // size of the inner array of the field being written
  bool blank_ = false;
};

// Files of one export.
class Exporter {
 public:
  explicit Exporter(std::string folder) : folder_(std::move(folder)) {
    std::filesystem::create_directories(folder_);
  }

  template <class Message>
  void add(const LoggedEvent& event) {
    Message message{};
    if (!decode_checked(event.data, message)) {
      ++result.undecodable;
      return;
    }
    RowCounter counter;
    visit_fields(counter, message);
    const std::string family(family_of(without_repair(event.channel)));
    std::ostream& file = file_of<Message>(family);
    const std::string start =
        std::to_string(event.number) + "," + std::to_string(event.stamp_us) + "," + event.channel;
    for (std::size_t row = 0; row < counter.rows; ++row) {
      std::string line = start;
      RowWriter writer(line, RowWriter::What::kValues, row);
      visit_fields(writer, message);
      file << line << "\n";
    }
    result.rows_by_file[path_of(family)] += static_cast<std::int64_t>(counter.rows);
  }

  // Commits the files. An earlier export is replaced only after all files of this one are complete.
  void close() {
    for (auto& [family, file] : files_) {
      file.text.close();
      if (!file.text) throw std::runtime_error("cannot write " + path_of(family));
    }
    for (auto& [family, file] : files_) file.replacement.commit();
    bus::any_channel([&]<class Message>(const auto& channel) {
      const std::string family(family_of(prefix_of(channel)));
      if (!files_.contains(family)) std::filesystem::remove(path_of(family));
      return false;
    });
  }

  ExportResult result;

 private:
  struct File {
    explicit File(const std::string& path) : replacement(path), text(replacement.temporary_path()) {}
    AtomicFile replacement;
    std::ofstream text;
  };
  std::string path_of(std::string family) const {
    std::transform(family.begin(), family.end(), family.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return folder_ + "/" + family + ".csv";
  }
  static std::string_view prefix_of(std::string_view channel) { return channel; }
  static std::string_view prefix_of(const bus::Family& family) { return family.prefix; }

  template <class Message>
  std::ostream& file_of(const std::string& family) {
    const auto [entry, is_new] = files_.try_emplace(family, path_of(family));
    std::ofstream& file = entry->second.text;
    if (is_new) {
      if (!file) throw std::runtime_error("cannot write " + path_of(family));
      std::string header = "event,stamp_us,channel";
      RowWriter writer(header, RowWriter::What::kNames, 0);
      visit_fields(writer, Message{});
      file << header << "\n";
    }
    return file;
  }

  std::string folder_;
  std::map<std::string, File> files_;
};

}  // namespace

ExportResult export_csv(LogReader& log, const std::string& folder, const std::string& channel_pattern) {
  const bus::ChannelPattern wanted(channel_pattern.empty() ? ".*" : channel_pattern);
  Exporter exporter(folder);
  LoggedEvent event;
  while (log.next(event)) {
    if (!wanted.matches(event.channel)) continue;
    const bool ours = with_type_of(event.channel, [&]<class Message>() { exporter.add<Message>(event); });
    if (!ours) ++exporter.result.foreign;
  }
  exporter.close();
  return exporter.result;
}

}  // namespace halocline::clients
