// The parsed TOML behind a ConfigFile and the reader that fills structs from it. Only config_*.cc include
// this: it is what keeps toml++ out of every other file.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "bus/config/config.h"
#include "core/frames.h"

namespace halocline::bus {

struct ConfigDocument {
  std::string path;
  toml::table root;
  std::vector<std::string> errors;
  std::set<const toml::node*> read;      // values that have been read
  std::set<const toml::table*> entered;  // tables that a read entered
  std::set<const toml::table*> shared;   // tables whose other keys are read by other programs

  // "file:line", or "command line" for an override.
  std::string place_of(const toml::node& node) const;
  std::string folder() const;
  // Kept once, however often it is found.
  void add_error(const std::string& error);
};

// The table as TOML, keys in alphabetical order.
std::string to_text(const toml::table& table);

// Fills structs from one table of the document; `prefix` names the table in errors ("environment.").
class ConfigReader : public ConfigVisitor {
 public:
  ConfigReader(ConfigDocument& document, toml::table& table, std::string prefix);

  void number(std::string_view key, double& value, const NumberRule& rule) override;
  void integer(std::string_view key, std::int64_t& value, const NumberRule& rule) override;
  void boolean(std::string_view key, bool& value, std::string_view meaning) override;
  void text(std::string_view key, std::string& value, const std::vector<std::string>& allowed,
            std::string_view meaning) override;
  void vector3(std::string_view key, Vec3& value, const NumberRule& rule) override;
  void numbers(std::string_view key, std::vector<double>& values, const NumberRule& rule) override;
  void points(std::string_view key, std::vector<Vec3>& values, const NumberRule& rule) override;
  void section(std::string_view key, std::string_view meaning,
               const std::function<void(ConfigVisitor&)>& body) override;
  void list(std::string_view key, std::string_view meaning, std::size_t count,
            const std::function<void(std::size_t)>& resize,
            const std::function<void(ConfigVisitor&, std::size_t)>& item) override;
  bool given(std::string_view key) const override { return table_.contains(key); }
  bool writing() const override { return false; }
  std::string folder() const override { return document_.folder(); }
  void problem(std::string_view key, std::string_view what_is_allowed) override;
  void shared_with_others() override { document_.shared.insert(&table_); }

 private:
  toml::node* find(std::string_view key);
  void fail(const toml::node& node, std::string_view key, const std::string& allowed);
  bool read_number(const toml::node& node, std::string_view key, const NumberRule& rule, double& value);
  bool read_numbers(const toml::node& node, std::string_view key, const NumberRule& rule,
                    std::vector<double>& values);
  bool read_point(const toml::node& node, std::string_view key, const NumberRule& rule, Vec3& value);

  ConfigDocument& document_;
  toml::table& table_;
  std::string prefix_;
};

}  // namespace halocline::bus
