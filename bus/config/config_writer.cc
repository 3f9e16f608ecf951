// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "bus/config/carried_files.h"
#include "bus/config/config.h"
#include "bus/config/config_document.h"
#include "core/files/file_path.h"
#include "core/frames.h"

namespace halocline::bus {

// Returns the shortest decimal that reads back as the same double; always with a point or exponent, as TOML
// requires for floats.
std::string exact(double value) {
  char text[40];
  for (int digits = 1; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    const bool plain = std::strchr(text, 'e') == nullptr || std::abs(value) >= 1e9 || std::abs(value) < 1e-4;
    if (std::strtod(text, nullptr) == value && plain) break;
  }
  const std::string shortest = text;
  return shortest.find_first_of(".einf") == std::string::npos ? shortest + ".0" : shortest;
}

std::string toml_quoted(const std::string& value) {
  std::string text = "\"";
  for (const char c : value) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '\\' || c == '"') text += '\\';
    if (code < 0x20 || code == 0x7f) {  // control characters: TOML accepts only their code
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04X", unsigned{code});
      text += escape;
    } else {
      text += c;
    }
  }
  return text + "\"";
}

namespace {

// ---- a document that was read

class DocumentPrinter {
 public:
  DocumentPrinter(const ConfigDocument& document, const std::vector<std::string>& left_out,
                  CarriedFiles& files)
      : document_(document), left_out_(left_out.begin(), left_out.end()), files_(files) {}

  // Prints values before sections, as TOML requires.
  void print(const toml::table& table, const std::string& path, std::ostream& out) {
    for (const auto& [key, value] : table) {
      if (!is_section(value) && !left_out_.contains(path + std::string(key.str())))
        out << key.str() << " = " << text_of(value) << "\n";
    }
    for (const auto& [key, value] : table) {
      const std::string name = path + std::string(key.str());
      if (const toml::table* section = value.as_table()) {
        if (is_left_out(*section, name)) continue;
        out << "\n[" << name << "]\n";
        print(*section, name + ".", out);
      } else if (value.is_array_of_tables()) {
        for (const toml::node& item : *value.as_array()) {
          out << "\n[[" << name << "]]\n";
          print(*item.as_table(), name + ".", out);
        }
      }
    }
  }

 private:
  static bool is_section(const toml::node& node) { return node.is_table() || node.is_array_of_tables(); }
  // True if every key of the section is left out.
  bool is_left_out(const toml::table& section, const std::string& name) const {
    return !section.empty() && std::all_of(section.begin(), section.end(), [&](const auto& entry) {
      return left_out_.contains(name + "." + std::string(entry.first.str()));
    });
  }
  std::string text_of(const toml::node& node) {
    if (const auto found = document_.files.find(&node); found != document_.files.end())
      return toml_quoted(names_of(found->second, document_.counting.contains(&node)));
    if (const auto* number = node.as_floating_point()) return exact(number->get());
    if (const auto* text = node.as_string()) return toml_quoted(text->get());
    if (const toml::array* array = node.as_array()) return text_of(*array);
    if (const toml::table* table = node.as_table()) return text_of(*table);
    std::ostringstream out;
    node.visit([&](const auto& value) {
      if constexpr (toml::is_value<decltype(value)>) out << value;
    });
    return out.str();
  }
  std::string text_of(const toml::array& array) {
    std::string text;
    const bool has_lists = !array.empty() && !array.front().is_value();
    for (const toml::node& element : array)
      text += (has_lists ? "\n  " : text.empty() ? "" : " ") + text_of(element) + ",";
    return "[" + text + (has_lists ? "\n]" : "]");
  }
  std::string text_of(const toml::table& table) {
    std::string text;
    for (const auto& [key, value] : table)
      text += (text.empty() ? "" : ", ") + std::string(key.str()) + " = " + text_of(value);
    return "{" + text + "}";
  }
  // A key that does not apply keeps its text, and its files are not carried: nothing checked that they are
  // what the key is for.
  std::string names_of(const ConfigDocument::Files& files, bool counts) {
    std::string text;
    for (const FilePath& path : files.paths)
      text += (text.empty() ? "" : " ") + (counts ? files_.name_of(path, files.names) : path.given());
    return text;
  }

  const ConfigDocument& document_;
  std::set<std::string> left_out_;
  CarriedFiles& files_;
};

// ---- structs that are written

// A table to be written. Several bodies may visit one table (each program its keys of [[vehicle]]): the first
// visit of a key, a section or an item creates it, later visits add further keys.
struct Table {
  std::string header;      // comment and [path] line; empty for the document itself
  bool is_listed = false;  // prints its header even without keys
  std::vector<std::pair<std::string, std::string>> lines;  // key, and its complete line
  std::vector<std::string> order;                          // order of sections and lists
  std::map<std::string, std::vector<std::unique_ptr<Table>>, std::less<>> tables;

  // Returns the i-th table under `key`, and creates it if it is missing.
  Table& table(const std::string& key, std::size_t i, const std::string& table_header, bool listed) {
    if (!tables.contains(key)) order.push_back(key);
    auto& list = tables[key];
    if (i >= list.size()) {
      list.push_back(std::make_unique<Table>());
      list.back()->header = table_header;
      list.back()->is_listed = listed;
    }
    return *list[i];
  }
  void add_line(std::string_view key, std::string line) {
    for (const auto& [known, text] : lines) {
      if (known == key) return;
    }
    lines.emplace_back(key, std::move(line));
  }
  // TOML requires a table's own keys before its sub-tables.
  std::string text() const {
    std::string body;
    for (const auto& [key, line] : lines) body += line;
    for (const std::string& key : order) {
      for (const auto& table : tables.find(key)->second) body += table->text();
    }
    return body.empty() && !is_listed ? "" : header + body;
  }
};

class Writer : public ConfigVisitor {
 public:
  // Writes every key with comments, or, without them, only the keys that apply; with `only` the keys of that
  // class alone.
  Writer(Table& table, std::string path, bool with_comments, std::optional<KeyClass> only,
         CarriedFiles& files, KeyClass key_class = KeyClass::kCommon)
      : table_(table), path_(std::move(path)), with_comments_(with_comments), only_(only), files_(files) {
    key_class_ = key_class;
  }

  void number(std::string_view key, double& value, const NumberRule& rule) override {
    line(key, exact(value), described(rule));
  }
  void integer(std::string_view key, std::int64_t& value, const NumberRule& rule) override {
    line(key, std::to_string(value), described(rule));
  }
  void boolean(std::string_view key, bool& value, std::string_view meaning) override {
    line(key, value ? "true" : "false", std::string(meaning));
  }
  void text(std::string_view key, std::string& value, const std::vector<std::string>& allowed,
            std::string_view meaning) override {
    std::string comment(meaning);
    for (std::size_t i = 0; i < allowed.size(); ++i) comment += (i == 0 ? ": " : ", ") + allowed[i];
    line(key, toml_quoted(value), comment);
  }
  void file(std::string_view key, FilePath& value, FileNames names, std::string_view meaning) override {
    line(key, toml_quoted(name_of(value, names)), std::string(meaning));
  }
  void files(std::string_view key, std::vector<FilePath>& values, FileNames names,
             std::string_view meaning) override {
    std::string text;
    for (const FilePath& value : values) text += (text.empty() ? "" : " ") + name_of(value, names);
    line(key, toml_quoted(text), std::string(meaning));
  }
  void vector3(std::string_view key, Vec3& value, const NumberRule& rule) override {
    line(key, array(value), described(rule));
  }
  void numbers(std::string_view key, std::vector<double>& values, const NumberRule& rule) override {
    std::string text;
    for (const double value : values) text += (text.empty() ? "" : ", ") + exact(value);
    line(key, "[" + text + "]", described(rule));
  }
  void points(std::string_view key, std::vector<Vec3>& values, const NumberRule& rule) override {
    std::string text;
    for (const Vec3& value : values) text += (text.empty() ? "" : ", ") + array(value);
    line(key, "[" + text + "]", described(rule));
  }
  void pairs(std::string_view key, std::vector<std::array<double, 2>>& values,
             const NumberRule& rule) override {
    std::string text;
    for (const auto& [first, second] : values)
      text += (text.empty() ? "[" : ", [") + exact(first) + ", " + exact(second) + "]";
    line(key, "[" + text + "]", described(rule));
  }
  void section(std::string_view key, std::string_view meaning,
               const std::function<void(ConfigVisitor&)>& body) override {
    if (is_left_out()) return;
    const std::string path = path_ + std::string(key);
    Writer nested = inner(key, 0, comment_line(meaning) + "[" + path + "]");
    body(nested);
  }
  void list(std::string_view key, std::string_view meaning, std::size_t count,
            const std::function<void(std::size_t)>& /*resize*/,
            const std::function<void(ConfigVisitor&, std::size_t)>& item) override {
    if (is_left_out()) return;
    const std::string path = path_ + std::string(key);
    for (std::size_t i = 0; i < count; ++i) {
      Writer nested = inner(key, i, comment_line(i == 0 ? meaning : "") + "[[" + path + "]]");
      item(nested, i);
    }
  }
  bool given(std::string_view) const override { return true; }
  bool is_text(std::string_view) const override { return false; }
  bool writing() const override { return true; }
  void problem(std::string_view, std::string_view) override {}
  void shared_with_others() override {}

 private:
  // Returns a writer of the i-th table under `key`.
  Writer inner(std::string_view key, std::size_t i, const std::string& header) {
    Table& table = table_.table(std::string(key), i, "\n" + header + "\n", is_listed());
    return {table, path_ + std::string(key) + ".", with_comments_, only_, files_, key_class_};
  }
  // Files of keys that are left out are not carried.
  std::string name_of(const FilePath& path, FileNames names) {
    return is_left_out() ? "" : files_.name_of(path, names);
  }
  bool is_left_out() const { return !with_comments_ && !missing_choice_.empty(); }
  bool is_listed() const { return !only_ || *only_ == key_class_; }
  void line(std::string_view key, const std::string& value, const std::string& comment) {
    if (is_left_out() || !is_listed()) return;
    const std::string tail = with_comments_ && !comment.empty() ? "  # " + comment : "";
    table_.add_line(key, std::string(key) + " = " + value + tail + "\n");
  }
  std::string comment_line(std::string_view meaning) const {
    return with_comments_ && !meaning.empty() ? "# " + std::string(meaning) + "\n" : "";
  }
  static std::string array(const Vec3& v) {
    return "[" + exact(v.x()) + ", " + exact(v.y()) + ", " + exact(v.z()) + "]";
  }
  static std::string described(const NumberRule& rule) {
    std::ostringstream text;
    text << rule.meaning << " (" << rule.lowest << " to " << rule.highest << (rule.unit.empty() ? "" : " ")
         << rule.unit << ")";
    return text.str();
  }

  Table& table_;
  std::string path_;
  bool with_comments_;
  std::optional<KeyClass> only_;
  CarriedFiles& files_;
};

std::string written(const std::function<void(ConfigVisitor&)>& body, bool with_comments,
                    CarriedFiles::Which which, std::optional<KeyClass> only = std::nullopt) {
  Table document;
  CarriedFiles files(which);
  Writer writer(document, "", with_comments, only, files);
  body(writer);
  return document.text() + files.to_toml();
}

}  // namespace

std::string to_toml(const std::function<void(ConfigVisitor&)>& body, bool with_comments) {
  return written(body, with_comments, CarriedFiles::Which::kUnpacked);
}

std::string to_portable_toml(const std::function<void(ConfigVisitor&)>& body) {
  return written(body, /*with_comments=*/false, CarriedFiles::Which::kAll);
}

std::string to_key_list(const std::function<void(ConfigVisitor&)>& body, KeyClass key_class) {
  return written(body, /*with_comments=*/true, CarriedFiles::Which::kUnpacked, key_class);
}

std::string to_text(const ConfigDocument& document, const std::vector<std::string>& left_out,
                    CarriedFiles& files) {
  std::ostringstream out;
  DocumentPrinter(document, left_out, files).print(document.root, "", out);
  return out.str();
}

}  // namespace halocline::bus
