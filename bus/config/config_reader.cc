// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "bus/config/carried_files.h"
#include "bus/config/config.h"
#include "bus/config/config_document.h"
#include "core/files/file_path.h"
#include "core/frames.h"
#include "core/names.h"
#include "core/text/utf8.h"

namespace halocline::bus {
namespace {

std::string number_text(double value) {
  std::ostringstream text;
  text.precision(12);
  text << value;
  return text.str();
}

std::string allowed_text(const NumberRule& rule) {
  std::string text = "allowed is " + number_text(rule.lowest) + " to " + number_text(rule.highest);
  if (!rule.unit.empty()) text += " " + std::string(rule.unit);
  return text;
}

// Converts a value to text; toml++ would write large floats with all their digits.
std::string whole_value_text(const toml::node& node) {
  if (node.is_table()) return "a table";
  if (const auto* number = node.as_floating_point()) return exact(number->get());
  std::ostringstream text;
  if (const toml::array* array = node.as_array()) {
    for (const toml::node& element : *array)
      text << (text.tellp() == 0 ? "[ " : ", ") << whole_value_text(element);
    return array->empty() ? "[]" : text.str() + " ]";
  }
  node.visit([&](const auto& value) { text << value; });
  return text.str();
}

}  // namespace

std::string value_text(const toml::node& node) {
  constexpr std::size_t kMaxBytes = 120;
  const std::string text = whole_value_text(node);
  if (text.size() <= kMaxBytes) return text;
  return beginning_of(text, kMaxBytes) + "... (" + std::to_string(text.size()) + " characters)";
}

std::string ConfigDocument::place_of(const toml::node& node) const {
  const toml::source_region& source = node.source();
  if (source.path == nullptr) return path;  // a section that the file does not have
  if (is_override(node)) return *source.path;
  return *source.path + ":" + std::to_string(source.begin.line);
}

bool ConfigDocument::is_override(const toml::node& node) const {
  return node.source().path != nullptr && *node.source().path == kCommandLine;
}

std::string ConfigDocument::folder() const {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

std::string ConfigDocument::folder_of(const toml::node& node) const {
  const toml::source_path_ptr& stated = node.source().path;
  const bool is_included =
      stated != nullptr && std::find(included.begin(), included.end(), *stated) != included.end();
  return is_included ? std::filesystem::path(*stated).parent_path().string() : folder();
}

void ConfigDocument::unpack_files() {
  toml::node* node = root.get("file");
  if (node == nullptr) return;
  const toml::array* tables = node->as_array();
  if (tables == nullptr || !tables->is_homogeneous(toml::node_type::table))
    throw ConfigErrors({place_of(*node) + ": file; an array of tables [[file]] is needed"});
  std::string name;
  try {
    unpacked = std::make_shared<UnpackedFiles>();
    for (const toml::node& table : *tables) {
      name = (*table.as_table())["name"].value_or(std::string());
      unpack(*table.as_table(), *unpacked);
    }
  } catch (const std::exception& error) {
    throw ConfigErrors({place_of(*node) + ": file '" + name + "'; " + error.what()});
  }
  root.erase("file");
}

FilePath ConfigDocument::resolved(const toml::node& node, const std::string& given, FileNames names) {
  if (!names_a_file(given, names)) return FilePath(given);
  for (const FilePath& earlier : files[&node].paths)
    if (earlier.given() == given) return earlier;
  const bool is_own = !is_override(node);
  if (const auto place = is_own && unpacked ? unpacked->place_of(given) : std::nullopt) {
    if (const std::string difference = unpacked->difference(given); !difference.empty())
      add_warning(place_of(node) + ": " + *place + ": " + difference);
    return {given, *place, std::make_shared<FileOrigin>(FileOrigin{unpacked, nullptr})};
  }
  const std::filesystem::path place =
      is_own ? std::filesystem::path(folder_of(node)) / given : std::filesystem::path(given);
  return {given, place.string(), std::make_shared<FileOrigin>()};
}

void ConfigDocument::add_error(const std::string& error) {
  if (std::find(errors.begin(), errors.end(), error) == errors.end()) errors.push_back(error);
}

void ConfigDocument::add_warning(const std::string& warning) {
  if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end()) warnings.push_back(warning);
}

ConfigReader::ConfigReader(ConfigDocument& document, toml::table& table, std::string prefix,
                           const std::string& missing_choice)
    : document_(document), table_(table), prefix_(std::move(prefix)), is_warned_of_(!missing_choice.empty()) {
  missing_choice_ = missing_choice;
  document_.entered.insert(&table_);
}

void ConfigReader::note(std::string_view key) const {
  document_.known[without_indices(prefix_)].emplace(key);
}

toml::node* ConfigReader::find(std::string_view key) {
  note(key);
  toml::node* node = table_.get(key);
  if (node == nullptr) return node;
  document_.read.insert(node);
  note_use(*node, key);
  return node;
}

void ConfigReader::note_use(const toml::node& node, std::string_view key) {
  if (missing_choice_.empty()) {
    document_.counting.insert(&node);
  } else if (!is_warned_of_) {
    document_.idle.emplace_back(&node, document_.place_of(node) + ": " + prefix_ + std::string(key) + " is " +
                                           value_text(node) + "; it has no effect, it counts only with " +
                                           missing_choice_);
  }
}

void ConfigReader::fail(const toml::node& node, std::string_view key, const std::string& allowed) {
  document_.add_error(document_.place_of(node) + ": " + prefix_ + std::string(key) + " is " +
                      value_text(node) + "; " + allowed);
}

void ConfigReader::problem(std::string_view key, std::string_view what_is_allowed) {
  if (const toml::node* node = find(key)) return fail(*node, key, std::string(what_is_allowed));
  document_.add_error(document_.place_of(table_) + ": " + prefix_ + std::string(key) + " is missing; " +
                      std::string(what_is_allowed));
}

bool ConfigReader::read_number(const toml::node& node, std::string_view key, const NumberRule& rule,
                               double& value) {
  const std::optional<double> read = node.is_number() ? node.value<double>() : std::nullopt;
  if (read && *read >= rule.lowest && *read <= rule.highest) {
    value = *read;
    return true;
  }
  fail(node, key, (read ? "" : "a number is needed, ") + allowed_text(rule));
  return false;
}

void ConfigReader::number(std::string_view key, double& value, const NumberRule& rule) {
  if (const toml::node* node = find(key)) read_number(*node, key, rule, value);
}

void ConfigReader::integer(std::string_view key, std::int64_t& value, const NumberRule& rule) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const std::optional<std::int64_t> read = node->is_integer() ? node->value<std::int64_t>() : std::nullopt;
  if (read && static_cast<double>(*read) >= rule.lowest && static_cast<double>(*read) <= rule.highest) {
    value = *read;
  } else {
    fail(*node, key, (read ? "" : "a whole number is needed, ") + allowed_text(rule));
  }
}

void ConfigReader::boolean(std::string_view key, bool& value, std::string_view /*meaning*/) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  if (!node->is_boolean()) return fail(*node, key, "allowed is true or false");
  value = *node->value<bool>();
}

void ConfigReader::text(std::string_view key, std::string& value, const std::vector<std::string>& allowed,
                        std::string_view /*meaning*/) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  std::string names;
  for (const std::string& name : allowed) names += (names.empty() ? "" : ", ") + name;
  // A word on the command line may look like a number or a date.
  const bool is_word = node->is_value() && document_.is_override(*node);
  if (!node->is_string() && !is_word)
    return fail(*node, key, "a text is needed" + (names.empty() ? "" : ", allowed are " + names));
  const std::string read = node->value<std::string>().value_or(value_text(*node));
  if (!allowed.empty() && std::find(allowed.begin(), allowed.end(), read) == allowed.end()) {
    return fail(*node, key, "allowed are " + names);
  }
  if (!is_one_line(read)) return fail(*node, key, "allowed is " + std::string(kLineRule));
  value = read;
}

bool ConfigReader::read_numbers(const toml::node& node, std::string_view key, const NumberRule& rule,
                                std::vector<double>& values) {
  const toml::array* array = node.as_array();
  if (array == nullptr) {
    fail(node, key, "an array of numbers is needed, each: " + allowed_text(rule));
    return false;
  }
  std::vector<double> read(array->size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    if (!read_number(*array->get(i), key, rule, read[i])) return false;
  }
  values = std::move(read);
  return true;
}

void ConfigReader::numbers(std::string_view key, std::vector<double>& values, const NumberRule& rule) {
  if (const toml::node* node = find(key)) read_numbers(*node, key, rule, values);
}

bool ConfigReader::read_point(const toml::node& node, std::string_view key, const NumberRule& rule,
                              Vec3& value) {
  std::vector<double> read;
  if (!read_numbers(node, key, rule, read)) return false;
  if (read.size() != 3) {
    fail(node, key, "three numbers are needed, each: " + allowed_text(rule));
    return false;
  }
  value = Vec3(read[0], read[1], read[2]);
  return true;
}

const toml::node* ConfigReader::find_files(std::string_view key, std::string& given,
                                           std::string_view meaning) {
  const toml::node* node = find(key);
  text(key, given, {}, meaning);
  return node != nullptr && (node->is_string() || document_.is_override(*node)) ? node : nullptr;
}

void ConfigReader::file(std::string_view key, FilePath& value, FileNames names, std::string_view meaning) {
  std::string given = value.given();
  const toml::node* node = find_files(key, given, meaning);
  if (node == nullptr) return;
  value = document_.resolved(*node, given, names);
  document_.files[node] = {{value}, names};
}

void ConfigReader::files(std::string_view key, std::vector<FilePath>& values, FileNames names,
                         std::string_view meaning) {
  std::string given;
  const toml::node* node = find_files(key, given, meaning);
  if (node == nullptr) return;
  values.clear();
  std::istringstream list(given);
  for (std::string one; list >> one;) values.push_back(document_.resolved(*node, one, names));
  document_.files[node] = {values, names};
}

void ConfigReader::vector3(std::string_view key, Vec3& value, const NumberRule& rule) {
  if (const toml::node* node = find(key)) read_point(*node, key, rule, value);
}

void ConfigReader::points(std::string_view key, std::vector<Vec3>& values, const NumberRule& rule) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const toml::array* array = node->as_array();
  if (array == nullptr) return fail(*node, key, "an array of [x, y, z] is needed");
  std::vector<Vec3> read(array->size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    if (!read_point(*array->get(i), key, rule, read[i])) return;
  }
  values = std::move(read);
}

void ConfigReader::pairs(std::string_view key, std::vector<std::array<double, 2>>& values,
                         const NumberRule& rule) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const toml::array* array = node->as_array();
  if (array == nullptr) return fail(*node, key, "an array of [a, b] is needed");
  std::vector<std::array<double, 2>> read;
  for (const toml::node& element : *array) {
    std::vector<double> numbers;
    if (!read_numbers(element, key, rule, numbers)) return;
    if (numbers.size() != 2) return fail(element, key, "two numbers are needed, each: " + allowed_text(rule));
    read.push_back({numbers[0], numbers[1]});
  }
  values = std::move(read);
}

void ConfigReader::section(std::string_view key, std::string_view /*meaning*/,
                           const std::function<void(ConfigVisitor&)>& body) {
  toml::node* node = find(key);
  toml::table missing;  // an absent section is read as an empty one, so that its required keys are checked
  toml::table* table = node != nullptr ? node->as_table() : &missing;
  if (table == nullptr) return fail(*node, key, "a table [" + prefix_ + std::string(key) + "] is needed");
  ConfigReader reader(document_, *table, prefix_ + std::string(key) + ".", missing_choice_);
  body(reader);
  document_.entered.erase(&missing);
  document_.shared.erase(&missing);
}

void ConfigReader::list(std::string_view key, std::string_view /*meaning*/, std::size_t /*count*/,
                        const std::function<void(std::size_t)>& resize,
                        const std::function<void(ConfigVisitor&, std::size_t)>& item) {
  toml::node* node = find(key);
  if (node == nullptr) return;
  toml::array* array = node->as_array();
  if (array == nullptr || !array->is_homogeneous(toml::node_type::table)) {
    if (array != nullptr && array->empty()) return resize(0);
    return fail(*node, key, "an array of tables [[" + prefix_ + std::string(key) + "]] is needed");
  }
  resize(array->size());
  for (std::size_t i = 0; i < array->size(); ++i) {
    ConfigReader reader(document_, *array->get_as<toml::table>(i),
                        prefix_ + std::string(key) + "[" + std::to_string(i) + "].", missing_choice_);
    item(reader, i);
  }
}

}  // namespace halocline::bus
