// SPDX-License-Identifier: BSD-3-Clause
// The parsed TOML behind a ConfigFile, and the reader that fills structs from it. Only config_*.cc include
// this header, which keeps toml++ out of all other files.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include "bus/config/carried_files.h"
#include "bus/config/config.h"
#include "core/files/file_path.h"
#include "core/frames.h"

namespace halocline::bus {

// Name of overrides in error messages.
inline constexpr std::string_view kCommandLine = "command line";

struct ConfigDocument {
  std::string path;
  toml::table root;
  std::vector<std::string> errors;
  std::vector<std::string> warnings;
  std::set<const toml::node*> read;      // values that have been read
  std::set<const toml::node*> counting;  // read values that applied to some read
  // Read values that did not apply, with their warnings.
  std::vector<std::pair<const toml::node*, std::string>> idle;
  std::set<const toml::table*> entered;  // tables that a read entered
  std::set<const toml::table*> shared;   // tables whose other keys are read by other programs
  struct Files {
    std::vector<FilePath> paths;
    FileNames names = FileNames::kFiles;
  };
  std::map<const toml::node*, Files> files;
  std::shared_ptr<UnpackedFiles> unpacked;  // carried by the configuration; null: none
  std::vector<std::string> included;        // files whose values are in `root` as if it stated them
  // Keys that any read visited, by their table ("vehicle.modem."; items of a list share one).
  std::map<std::string, std::set<std::string, std::less<>>> known;

  // Returns "file:line", or "command line" for an override.
  std::string place_of(const toml::node& node) const;
  [[nodiscard]] bool is_override(const toml::node& node) const;
  std::string folder() const;
  // Returns the folder of the file that states the node: the document's, or that of an included file.
  [[nodiscard]] std::string folder_of(const toml::node& node) const;
  // Returns the file that the key of `node` names, with its place. Two calls for one key give the same
  // origin.
  FilePath resolved(const toml::node& node, const std::string& given, FileNames names);
  // Removes the tables [[file]] from the document and unpacks them. Throws ConfigErrors for an invalid one.
  void unpack_files();
  // Repeated texts are kept once.
  void add_error(const std::string& error);
  void add_warning(const std::string& warning);
};

// Returns the document as TOML, keys in alphabetical order, without the keys `left_out` ("section.key");
// files are named as in `files`.
std::string to_text(const ConfigDocument& document, const std::vector<std::string>& left_out,
                    CarriedFiles& files);

// Adds the content of one table [[file]]. Throws InvalidArgument for an invalid one.
void unpack(const toml::table& table, UnpackedFiles& files);

// Returns a number and a text in TOML notation.
std::string exact(double value);
std::string toml_quoted(const std::string& value);

// Returns a value as in error messages; a long one is shortened.
std::string value_text(const toml::node& node);

// Removes the indices of list items from a name: "vehicle[0].modem." becomes "vehicle.modem.".
std::string without_indices(const std::string& name);

// Returns "; it is now KEY" or "; did you mean KEY?" for a key that no program reads, `prefix` naming its
// table as in error messages; empty if the key was not renamed and no known one is similar (known_keys.cc).
std::string suggestion_for(const ConfigDocument& document, const std::string& prefix, std::string_view key);

// Reader that fills structs from one table of the document; `prefix` names the table in errors
// ("environment.").
class ConfigReader : public ConfigVisitor {
 public:
  // `missing_choice` is set for a table that does not apply as a whole, for which a warning was issued.
  ConfigReader(ConfigDocument& document, toml::table& table, std::string prefix,
               const std::string& missing_choice = "");

  void number(std::string_view key, double& value, const NumberRule& rule) override;
  void integer(std::string_view key, std::int64_t& value, const NumberRule& rule) override;
  void boolean(std::string_view key, bool& value, std::string_view meaning) override;
  void text(std::string_view key, std::string& value, const std::vector<std::string>& allowed,
            std::string_view meaning) override;
  void file(std::string_view key, FilePath& value, FileNames names, std::string_view meaning) override;
  void files(std::string_view key, std::vector<FilePath>& values, FileNames names,
             std::string_view meaning) override;
  void vector3(std::string_view key, Vec3& value, const NumberRule& rule) override;
  void numbers(std::string_view key, std::vector<double>& values, const NumberRule& rule) override;
  void points(std::string_view key, std::vector<Vec3>& values, const NumberRule& rule) override;
  void pairs(std::string_view key, std::vector<std::array<double, 2>>& values,
             const NumberRule& rule) override;
  void section(std::string_view key, std::string_view meaning,
               const std::function<void(ConfigVisitor&)>& body) override;
  void list(std::string_view key, std::string_view meaning, std::size_t count,
            const std::function<void(std::size_t)>& resize,
            const std::function<void(ConfigVisitor&, std::size_t)>& item) override;
  bool given(std::string_view key) const override {
    note(key);
    return table_.contains(key);
  }
  bool is_text(std::string_view key) const override {
    note(key);
    return table_[key].is_string();
  }
  bool writing() const override { return false; }
  void problem(std::string_view key, std::string_view what_is_allowed) override;
  void shared_with_others() override { document_.shared.insert(&table_); }

 private:
  toml::node* find(std::string_view key);
  // Returns the node of a key that names files, and its text; null if it is not given, or not a text.
  const toml::node* find_files(std::string_view key, std::string& given, std::string_view meaning);
  void note(std::string_view key) const;
  void note_use(const toml::node& node, std::string_view key);
  void fail(const toml::node& node, std::string_view key, const std::string& allowed);
  bool read_number(const toml::node& node, std::string_view key, const NumberRule& rule, double& value);
  bool read_numbers(const toml::node& node, std::string_view key, const NumberRule& rule,
                    std::vector<double>& values);
  bool read_point(const toml::node& node, std::string_view key, const NumberRule& rule, Vec3& value);

  ConfigDocument& document_;
  toml::table& table_;
  std::string prefix_;
  bool is_warned_of_;
};

}  // namespace halocline::bus
