// SPDX-License-Identifier: BSD-3-Clause
// Description of a configuration struct, written once, from which it is read from TOML, printed, and
// explained in an example.
//
// Each `*_config.h` declares a plain struct with defaults and a function
//
//   void visit(ConfigVisitor& v, MyConfig& c) {
//     v.number("wind_mps", c.wind_mps, {0, 60, "m/s", "10 m above the sea"});
//   }
//
// A reader fills the struct and collects every error (wrong type, impossible value, unknown key) with file,
// line, key and the permitted values. A writer prints the effective configuration, or an example with
// comments. The struct is in SI units; configuration keys use degrees, hours or kilohertz only if their name
// says so, and visit() converts them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bus/config/carried_files.h"
#include "core/check.h"
#include "core/files/file_path.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::bus {

// Permitted range of a number; both ends are included.
struct NumberRule {
  double lowest;
  double highest;
  std::string_view unit;     // "" for pure numbers
  std::string_view meaning;  // one line
};

// Place of a key in the lists of keys: in the list that every user reads, in that of tuning for special
// vehicles, sensors and protocols, or under another section, which has the same keys.
enum class KeyClass { kCommon, kAdvanced, kListedElsewhere };

class ConfigVisitor {
 public:
  virtual ~ConfigVisitor() = default;

  // Each function visits one key of the current table; `value` holds the default on entry.
  virtual void number(std::string_view key, double& value, const NumberRule& rule) = 0;
  virtual void integer(std::string_view key, std::int64_t& value, const NumberRule& rule) = 0;
  virtual void boolean(std::string_view key, bool& value, std::string_view meaning) = 0;
  // `allowed` lists the permitted texts; empty: any text.
  virtual void text(std::string_view key, std::string& value, const std::vector<std::string>& allowed,
                    std::string_view meaning) = 0;
  // A file, given relative to the folder of the configuration file, or on the command line to the working
  // directory. It is read from FilePath::place(), wherever the program runs.
  virtual void file(std::string_view key, FilePath& value, FileNames names, std::string_view meaning) = 0;
  // Several files, separated by blanks.
  virtual void files(std::string_view key, std::vector<FilePath>& values, FileNames names,
                     std::string_view meaning) = 0;
  // vector3: an array of exactly three numbers. numbers: an array of any length.
  virtual void vector3(std::string_view key, Vec3& value, const NumberRule& rule) = 0;
  virtual void numbers(std::string_view key, std::vector<double>& values, const NumberRule& rule) = 0;
  // An array of arrays of three numbers (waypoints).
  virtual void points(std::string_view key, std::vector<Vec3>& values, const NumberRule& rule) = 0;
  // An array of arrays of two numbers (rows of a table).
  virtual void pairs(std::string_view key, std::vector<std::array<double, 2>>& values,
                     const NumberRule& rule) = 0;
  // A table within the current table.
  virtual void section(std::string_view key, std::string_view meaning,
                       const std::function<void(ConfigVisitor&)>& body) = 0;
  // An array of tables: `resize(n)` makes room, `item(v, i)` visits the i-th. On writing, `count` items are
  // written.
  virtual void list(std::string_view key, std::string_view meaning, std::size_t count,
                    const std::function<void(std::size_t)>& resize,
                    const std::function<void(ConfigVisitor&, std::size_t)>& item) = 0;
  // True when the scenario gives this key; always true on writing.
  virtual bool given(std::string_view key) const = 0;
  // True when the scenario gives this key a text, for keys that are a file's name or a value; false on
  // writing.
  virtual bool is_text(std::string_view key) const = 0;
  // True when a configuration is written: all effective values are to be visited, whatever `given` returns.
  virtual bool writing() const = 0;
  // Reports that the key's value is impossible for a reason that no rule covers, for instance in relation to
  // another key.
  virtual void problem(std::string_view key, std::string_view what_is_allowed) = 0;
  // This table also holds keys that other programs read: unknown keys are no errors here.
  virtual void shared_with_others() = 0;

  // Visits keys of the current table that apply only with some other choice: `counts` is true if that choice
  // is made, and `choice` names it as in the file, "kind = \"raster\"". A key that does not apply is still
  // read and checked; a warning is issued if the file gives it, and it is left out of the effective
  // configuration.
  void when(bool counts, std::string_view choice, const std::function<void()>& body);

  // Visits keys that tune; they are read and written as all others, and differ only in the list of keys.
  void advanced(const std::function<void()>& body) { with_class(KeyClass::kAdvanced, body); }
  // Visits keys that the list of keys shows under another section.
  void listed_elsewhere(const std::function<void()>& body) { with_class(KeyClass::kListedElsewhere, body); }

 protected:
  // Choice that is missing for the keys visited now; empty if they apply. Visitors of inner tables pass it
  // on.
  std::string missing_choice_;
  // Class of the keys visited now. Writers of inner tables inherit it.
  KeyClass key_class_ = KeyClass::kCommon;

 private:
  // An inner body cannot bring back what an outer one puts into a later class.
  void with_class(KeyClass key_class, const std::function<void()>& body);
};

// Visits an integer of another width through ConfigVisitor::integer().
template <class Integer>
void integer_as(ConfigVisitor& v, std::string_view key, Integer& value, const NumberRule& rule) {
  std::int64_t wide = static_cast<std::int64_t>(value);
  v.integer(key, wide, rule);
  value = static_cast<Integer>(wide);
}

// Visits an enumeration by name; `names[i]` belongs to static_cast<Enum>(i).
template <class Enum>
void choice(ConfigVisitor& v, std::string_view key, Enum& value, const std::vector<std::string>& names,
            std::string_view meaning) {
  std::string name = names.at(static_cast<std::size_t>(value));
  v.text(key, name, names, meaning);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) value = static_cast<Enum>(i);
  }
}

// Visits keys that apply only if the enumeration `key`, visited before by choice() with the same names, has
// one of `values`.
template <class Enum>
void when_one_of(ConfigVisitor& v, std::string_view key, Enum value, const std::vector<std::string>& names,
                 std::initializer_list<Enum> values, const std::function<void()>& body) {
  std::string choice;
  for (const Enum one : values)
    choice +=
        (choice.empty() ? std::string(key) + " = \"" : "\" or \"") + names.at(static_cast<std::size_t>(one));
  v.when(std::find(values.begin(), values.end(), value) != values.end(), choice + "\"", body);
}

// Returns the names of all values of an enumeration that has a to_name(), for choice().
template <class Enum, std::size_t count>
std::vector<std::string> names_of(const std::array<Enum, count>& values) {
  std::vector<std::string> names;
  for (const Enum value : values) names.emplace_back(to_name(value));
  return names;
}

// Visits a duration, which is in seconds in the file (its key ends in _s).
void seconds(ConfigVisitor& v, std::string_view key, SimDuration& value, const NumberRule& rule_in_seconds);

// Reports an error, with the reason, when the file that `key` names cannot be read.
void require_readable(ConfigVisitor& v, std::string_view key, const FilePath& path);

// Calls `attempt`, and reports an InvalidArgument that it throws as an error of the file, with the line of
// `key`.
void report_refusal(ConfigVisitor& v, std::string_view key, const std::function<void()>& attempt);

// Visits an angle, in degrees in the file (its key ends in _deg), in radians in the struct.
void degrees(ConfigVisitor& v, std::string_view key, double& radians, const NumberRule& rule_in_degrees);

// Visits an array of such angles.
void degrees(ConfigVisitor& v, std::string_view key, std::vector<double>& radians,
             const NumberRule& rule_in_degrees);

// Error that lists everything wrong with a configuration, one line for each fault, in the form
//
//   file:line: key: what; allowed is ...
class ConfigErrors : public InvalidArgument {
 public:
  explicit ConfigErrors(std::vector<std::string> lines);
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  std::vector<std::string> lines_;
};

struct ConfigDocument;  // the parsed TOML and its errors

// Parsed scenario file with overrides from the command line.
class ConfigFile {
 public:
  // Throws ConfigErrors when the file cannot be read or is no TOML. Each override is "section.key=value" with
  // a TOML value; "vehicle.0.key=value" addresses an array of tables. A key `include = "file.toml"` before
  // all sections names a file beside this one whose values replace this file's own, and are replaced by
  // overrides; such a file includes no other.
  static ConfigFile load(const std::string& path, const std::vector<std::string>& overrides = {});
  // Loads a file that another configuration names. It is carried along together with the files that it names
  // itself, and its warnings are added to those of the other configuration.
  static ConfigFile load_named(const FilePath& path);
  static ConfigFile parse(const std::string& text, const std::string& name_for_errors,
                          const std::vector<std::string>& overrides = {});
  ~ConfigFile();
  ConfigFile(ConfigFile&&) noexcept;
  ConfigFile& operator=(ConfigFile&&) noexcept;

  // Visits the whole document as one table. May be called several times, for several structs; errors
  // accumulate.
  void read(const std::function<void(ConfigVisitor&)>& body);
  // Throws ConfigErrors with all errors of the read() calls, and, with `whole_file`, with every key that no
  // read() visited. Without it, unknown keys are errors only in sections that were read and are not shared.
  void check(bool whole_file);

  // Findings that need several sections, or the files that they name. `key` is the complete path of a key,
  // given or not: "vehicle.0.mission.speed_mps"; `value` is the effective value, shown if the file does not
  // give the key. An error is thrown by the next check_findings(), together with all others; warnings are
  // kept.
  void refuse(const std::string& key, const std::string& value, const std::string& what_is_allowed);
  void warn(const std::string& key, const std::string& value, const std::string& what_to_know);
  // Throws ConfigErrors with all errors refused so far.
  void check_findings() const;
  // Texts "file:line: key is value; ...", in the order found.
  const std::vector<std::string>& warnings() const;

  const std::string& path() const;
  // Returns the files that were read: the configuration, and those that it names, whether their keys apply or
  // not.
  std::vector<std::string> inputs() const;
  // Throws InvalidArgument when `path`, a file to be written, is one of the inputs.
  void require_no_input(const std::string& path) const;
  // Returns the document with its overrides as TOML: keys in alphabetical order, no comments, without the
  // keys `left_out` ("section.key"); and with the files that it names (carried_files.h), so that it reads the
  // same on any host.
  std::string to_toml(const std::vector<std::string>& left_out = {}) const;

 private:
  explicit ConfigFile(std::shared_ptr<ConfigDocument> document);
  std::shared_ptr<ConfigDocument> document_;
};

// Returns the configuration as TOML: every key that applies, with its value; with_comments every key, with
// unit, range and meaning. to_toml() names files by their absolute place; to_portable_toml() carries them
// along.
std::string to_toml(const std::function<void(ConfigVisitor&)>& body, bool with_comments);
std::string to_portable_toml(const std::function<void(ConfigVisitor&)>& body);

// Returns the list of all keys of one class, with unit, range and meaning, whether they apply or not.
std::string to_key_list(const std::function<void(ConfigVisitor&)>& body, KeyClass key_class);

}  // namespace halocline::bus
