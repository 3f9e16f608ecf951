// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "bus/config/carried_files.h"
#include "bus/config/config.h"
#include "bus/config/config_document.h"
#include "core/check.h"
#include "core/files/file_path.h"
#include "core/files/input_file.h"
#include "core/names.h"

namespace halocline::bus {
namespace {

std::string parse_error_text(const std::string& where, const toml::parse_error& error) {
  std::ostringstream text;
  text << where << ":" << error.source().begin.line << ": " << error.description();
  return text.str();
}

// Maximum number of parts of a dotted key. toml++ nests a table for each part and frees them by recursion;
// together with its limit of 256 values within values this bounds the stack. The keys of a scenario have at
// most five parts.
constexpr int kMaxKeyParts = 32;

// Returns the position after the string that opens at `at` with one quote, or with three for a string of
// several lines.
std::size_t end_of_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string three(3, quote);
  const bool long_string = text.substr(at, 3) == three;
  for (std::size_t i = at + (long_string ? 3 : 1); i < text.size(); ++i) {
    if (quote == '"' && text[i] == '\\') {
      ++i;
    } else if (long_string && text.substr(i, 3) == three) {
      // The string may end with two quotes of its own.
      return std::min(text.find_first_not_of(quote, i), text.size());
    } else if (!long_string && (text[i] == quote || text[i] == '\n')) {
      return i + (text[i] == quote ? 1 : 0);
    }
  }
  return text.size();
}

// Returns the line of the first key with more than kMaxKeyParts parts; 0 if there is none.
std::ptrdiff_t line_of_deep_key(std::string_view text) {
  int parts = 1;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      i = end_of_string(text, i);
      continue;
    }
    if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
      continue;
    }
    if (std::string_view("\n=,[]{}").find(c) != std::string_view::npos) parts = 1;
    if (c == '.' && ++parts > kMaxKeyParts)
      return 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(i), '\n');
    ++i;
  }
  return 0;
}

// Every text in TOML is parsed here. Throws toml::parse_error.
toml::table parsed_table(const std::string& text, std::string_view name) {
  if (const std::ptrdiff_t line = line_of_deep_key(text); line != 0) {
    const toml::source_position place{static_cast<toml::source_index>(line), 1};
    const std::string problem = "a key has more than " + std::to_string(kMaxKeyParts) + " dotted parts";
    throw toml::parse_error(problem.c_str(), place);
  }
  return toml::parse(text, name);
}

// Throws ConfigErrors for a file that is too long to be a configuration.
std::string file_text(const std::string& path) {
  std::ifstream file(path);
  constexpr std::size_t kMaxBytes = 64u << 20;  // 16 384 vehicles take 15 MB
  std::string text;
  for (std::array<char, 65'536> part; file && text.size() <= kMaxBytes;) {
    file.read(part.data(), part.size());
    text.append(part.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (text.size() > kMaxBytes)
    throw ConfigErrors({path + ": is longer than 64 MB; a file in TOML is needed"});
  return text;
}

// Returns the member of a table by key, or of an array by index; null if there is none.
toml::node* child_of(toml::node& parent, std::string_view key) {
  if (toml::table* table = parent.as_table()) return table->get(key);
  toml::array* array = parent.as_array();
  const bool digits =
      !key.empty() && key.size() < 6 && key.find_first_not_of("0123456789") == std::string_view::npos;
  return array != nullptr && digits ? array->get(static_cast<std::size_t>(std::stoul(std::string(key))))
                                    : nullptr;
}

// Merges `from` into `into` key by key, recursively for tables; any other value is replaced.
void merge(toml::node& into, toml::table& from, const std::string& override_text) {
  for (auto&& [key, value] : from) {
    toml::node* target = child_of(into, key.str());
    if (target != nullptr && value.is_table() && !target->is_value()) {
      merge(*target, *value.as_table(), override_text);
    } else if (toml::table* table = into.as_table()) {
      // The value is moved, because a copy loses its origin, the command line.
      value.visit([&, name = key.str()](auto& given) { table->insert_or_assign(name, std::move(given)); });
    } else {
      throw ConfigErrors(
          {"override '" + override_text + "': there is no '" + std::string(key.str()) + "' to change"});
    }
  }
}

// Returns "section.key=word" with the word in quotes; empty if the value is not a plain word.
std::string with_quoted_word(const std::string& text) {
  const auto equals = text.find('=');
  const auto first = equals == std::string::npos ? equals : text.find_first_not_of(" \t", equals + 1);
  if (first == std::string::npos || std::string_view("\"'[{").find(text[first]) != std::string_view::npos)
    return "";
  const std::string word = text.substr(first, text.find_last_not_of(" \t") - first + 1);
  return is_one_line(word) ? text.substr(0, equals + 1) + toml_quoted(word) : "";
}

// A value that is not TOML is taken as a text, so that a shell needs no nested quotes: modem.profile=janus.
toml::table parsed_override(const std::string& text) {
  try {
    return parsed_table(text, kCommandLine);
  } catch (const toml::parse_error& error) {
    const std::string quoted = with_quoted_word(text);
    if (quoted.empty()) throw;
    return parsed_table(quoted, kCommandLine);
  }
}

void apply_override(toml::table& root, const std::string& text) {
  try {
    toml::table given = parsed_override(text);
    merge(root, given, text);
  } catch (const toml::parse_error& error) {
    throw ConfigErrors({"override '" + text + "': " + std::string(error.description()) +
                        "; allowed is section.key=value, with a value in TOML or a word"});
  }
}

void collect_unknown(ConfigDocument& document, const toml::table& table, const std::string& prefix,
                     bool whole_file);

void collect_unknown_in(ConfigDocument& document, const toml::node& node, const std::string& name,
                        bool whole_file) {
  if (const toml::table* table = node.as_table()) {
    if (whole_file || document.entered.contains(table))
      collect_unknown(document, *table, name + ".", whole_file);
  } else if (const toml::array* array = node.as_array()) {
    for (std::size_t i = 0; i < array->size(); ++i) {
      collect_unknown_in(document, *array->get(i), name + "[" + std::to_string(i) + "]", whole_file);
    }
  }
}

void collect_unknown(ConfigDocument& document, const toml::table& table, const std::string& prefix,
                     bool whole_file) {
  const bool tolerant = !whole_file && document.shared.contains(&table);
  for (const auto& [key, value] : table) {
    const std::string name = prefix + std::string(key.str());
    if (document.read.contains(&value)) {
      collect_unknown_in(document, value, name, whole_file);
    } else if (!tolerant) {
      const std::string suggestion = suggestion_for(document, prefix, key.str());
      document.add_error(
          document.place_of(value) + ": " + printable(name) + " is unknown" +
          (suggestion.empty() ? "; the keys of a scenario are in docs/scenarios.md" : suggestion));
    }
  }
}

// Converts "vehicle.0.modem" to the form of error messages, "vehicle[0].modem".
std::string with_brackets(const std::string& key) {
  std::string name;
  std::istringstream parts(key);
  for (std::string part; std::getline(parts, part, '.');) {
    const bool is_index = part.find_first_not_of("0123456789") == std::string::npos;
    if (is_index) {
      name += "[" + part + "]";
    } else {
      name += (name.empty() ? "" : ".") + part;
    }
  }
  return name;
}

// Returns "file:line: key is value; remark". For a key that the file does not give, the line is that of the
// innermost table on the way to it.
std::string finding(ConfigDocument& document, const std::string& key, const std::string& value,
                    const std::string& remark) {
  toml::node* node = &document.root;
  const toml::node* place = nullptr;
  std::istringstream parts(key);
  for (std::string part; node != nullptr && std::getline(parts, part, '.');) {
    node = child_of(*node, part);
    // An array of tables has no line of its own.
    if (node != nullptr && !node->is_array_of_tables()) place = node;
  }
  return (place != nullptr ? document.place_of(*place) : document.path) + ": " + with_brackets(key) + " is " +
         (node != nullptr ? value_text(*node) : value + " by default") + "; " + remark;
}

// Adds the warnings of the TOML files that have been read.
void add_warnings_of_files(ConfigDocument& document) {
  for (const auto& [node, files] : document.files) {
    for (const FilePath& path : files.paths) {
      const auto* origin = static_cast<const FileOrigin*>(path.origin().get());
      if (origin == nullptr || !origin->document || !document.counting.contains(node)) continue;
      for (const std::string& warning : origin->document->warnings) document.add_warning(warning);
    }
  }
}

// Adds the files that the document names, and those that they name in turn.
void add_inputs(const ConfigDocument& document, std::vector<std::string>& inputs) {
  inputs.insert(inputs.end(), document.included.begin(), document.included.end());
  for (const auto& [node, files] : document.files) {
    for (const FilePath& path : files.paths) {
      if (!names_a_file(path.given(), files.names)) continue;
      inputs.push_back(path.place());
      const auto* origin = static_cast<const FileOrigin*>(path.origin().get());
      if (origin != nullptr && origin->document) add_inputs(*origin->document, inputs);
    }
  }
}

// Puts the values of an included file in the place of the document's own, key by key; a warning names each
// value that is replaced by another. `prefix` names the table.
void include(ConfigDocument& document, toml::table& into, toml::table& from, const std::string& prefix) {
  for (auto&& [key, value] : from) {
    const std::string name = prefix + std::string(key.str());
    toml::node* own = into.get(key.str());
    if (own != nullptr && own->is_table() && value.is_table()) {
      include(document, *own->as_table(), *value.as_table(), name + ".");
      continue;
    }
    if (own != nullptr && value_text(*own) != value_text(value))
      document.add_warning(document.place_of(*own) + ": " + name + " is " + value_text(*own) + "; " +
                           document.place_of(value) + " replaces it by " + value_text(value));
    value.visit([&, word = key.str()](auto& given) { into.insert_or_assign(word, std::move(given)); });
  }
}

// Reads the file that the key `include` of the document names, whose values replace the document's own, and
// removes the key. Throws ConfigErrors when that file cannot be used.
void include_file(ConfigDocument& document) {
  const toml::node* node = document.root.get("include");
  if (node == nullptr) return;
  const auto refuse = [&](const std::string& why) {
    throw ConfigErrors({document.place_of(*node) + ": include is " + value_text(*node) + "; " + why});
  };
  if (!node->is_string()) refuse("the name of one file in TOML is needed");
  const std::string place = (std::filesystem::path(document.folder()) / node->as_string()->get()).string();
  if (const std::string reason = why_unreadable(place); !reason.empty())
    refuse("cannot read " + place + ": " + reason);
  toml::table included;
  try {
    included = parsed_table(file_text(place), place);
  } catch (const toml::parse_error& error) {
    throw ConfigErrors({parse_error_text(place, error)});
  }
  if (included.contains("include") || included.contains("file"))
    refuse("the file includes others itself; allowed is one that holds sections and keys alone");
  document.included.push_back(place);
  document.root.erase("include");
  include(document, document.root, included, "");
}

std::shared_ptr<ConfigDocument> parsed(const std::string& text, const std::string& path,
                                       const std::vector<std::string>& overrides) {
  auto document = std::make_shared<ConfigDocument>();
  document->path = path;
  try {
    document->root = parsed_table(text, path);
  } catch (const toml::parse_error& error) {
    throw ConfigErrors({parse_error_text(path, error)});
  }
  document->unpack_files();
  include_file(*document);
  for (const std::string& text_of_override : overrides) apply_override(document->root, text_of_override);
  return document;
}

}  // namespace

ConfigFile::ConfigFile(std::shared_ptr<ConfigDocument> document) : document_(std::move(document)) {}
ConfigFile::~ConfigFile() = default;
ConfigFile::ConfigFile(ConfigFile&&) noexcept = default;
ConfigFile& ConfigFile::operator=(ConfigFile&&) noexcept = default;

ConfigFile ConfigFile::load(const std::string& path, const std::vector<std::string>& overrides) {
  if (const std::string reason = why_unreadable(path); !reason.empty())
    throw ConfigErrors({path + ": cannot be read: " + reason + "; a file in TOML is needed"});
  return ConfigFile(parsed(file_text(path), path, overrides));
}

ConfigFile ConfigFile::load_named(const FilePath& path) {
  ConfigFile file = load(path.place(), {});
  auto* origin = static_cast<FileOrigin*>(path.origin().get());
  if (origin == nullptr) return file;
  file.document_->unpacked = origin->unpacked;
  origin->document = file.document_;
  return file;
}

ConfigFile ConfigFile::parse(const std::string& text, const std::string& name_for_errors,
                             const std::vector<std::string>& overrides) {
  return ConfigFile(parsed(text, name_for_errors, overrides));
}

void ConfigFile::read(const std::function<void(ConfigVisitor&)>& body) {
  ConfigReader reader(*document_, document_->root, "");
  body(reader);
}

void ConfigFile::check(bool whole_file) {
  if (!whole_file) document_->shared.insert(&document_->root);
  collect_unknown(*document_, document_->root, "", whole_file);
  for (const auto& [node, warning] : document_->idle)
    if (!document_->counting.contains(node)) document_->add_warning(warning);
  add_warnings_of_files(*document_);
  check_findings();
}

void ConfigFile::refuse(const std::string& key, const std::string& value,
                        const std::string& what_is_allowed) {
  document_->add_error(finding(*document_, key, value, what_is_allowed));
}

void ConfigFile::warn(const std::string& key, const std::string& value, const std::string& what_to_know) {
  document_->add_warning(finding(*document_, key, value, what_to_know));
}

void ConfigFile::check_findings() const {
  if (!document_->errors.empty()) throw ConfigErrors(document_->errors);
}

const std::vector<std::string>& ConfigFile::warnings() const { return document_->warnings; }

const std::string& ConfigFile::path() const { return document_->path; }

std::vector<std::string> ConfigFile::inputs() const {
  std::vector<std::string> inputs{document_->path};
  add_inputs(*document_, inputs);
  return inputs;
}

void ConfigFile::require_no_input(const std::string& path) const {
  std::error_code error;  // set when one of them does not exist
  for (const std::string& input : inputs())
    require(!std::filesystem::equivalent(path, input, error),
            path + " is what is read; allowed is another place to write to");
}

std::string ConfigFile::to_toml(const std::vector<std::string>& left_out) const {
  CarriedFiles files(CarriedFiles::Which::kAll);
  const std::string text = to_text(*document_, left_out, files);
  return text + files.to_toml();
}

}  // namespace halocline::bus
