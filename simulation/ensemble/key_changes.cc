// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/ensemble/key_changes.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

#include "bus/config/carried_files.h"
#include "bus/config/config.h"
#include "core/files/file_path.h"
#include "core/frames.h"

namespace halocline::clients {
namespace {

using channel_server::ChannelServerConfig;

// Visitor of a configuration that is in memory, which changes the values of some keys.
class KeyChanger : public bus::ConfigVisitor {
 public:
  // `has_modem[i]` is true when the i-th vehicle has a modem of its own.
  KeyChanger(const std::vector<KeyChange>& changes, const std::vector<bool>& has_modem, std::string path = "",
             bool without_modem = false)
      : changes_(changes), has_modem_(has_modem), path_(std::move(path)), without_modem_(without_modem) {}

  void number(std::string_view key, double& value, const bus::NumberRule& rule) override {
    for (const KeyChange& change : changes_)
      if (change.number && names(change, key))
        value = std::clamp(change.number(value), rule.lowest, rule.highest);
  }
  void text(std::string_view key, std::string& value, const std::vector<std::string>& allowed,
            std::string_view /*meaning*/) override {
    for (const KeyChange& change : changes_)
      if (change.text && names(change, key)) value = change.text(value, allowed);
  }
  void integer(std::string_view, std::int64_t&, const bus::NumberRule&) override {}
  void boolean(std::string_view, bool&, std::string_view) override {}
  void file(std::string_view, FilePath&, bus::FileNames, std::string_view) override {}
  void files(std::string_view, std::vector<FilePath>&, bus::FileNames, std::string_view) override {}
  void vector3(std::string_view, Vec3&, const bus::NumberRule&) override {}
  void numbers(std::string_view, std::vector<double>&, const bus::NumberRule&) override {}
  void points(std::string_view, std::vector<Vec3>&, const bus::NumberRule&) override {}
  void pairs(std::string_view, std::vector<std::array<double, 2>>&, const bus::NumberRule&) override {}
  void section(std::string_view key, std::string_view /*meaning*/,
               const std::function<void(ConfigVisitor&)>& body) override {
    KeyChanger inner(changes_, has_modem_, path_ + std::string(key) + ".");
    body(inner);
  }
  void list(std::string_view key, std::string_view /*meaning*/, std::size_t count,
            const std::function<void(std::size_t)>& /*resize*/,
            const std::function<void(ConfigVisitor&, std::size_t)>& item) override {
    for (std::size_t i = 0; i < count; ++i) {
      const bool without_modem = key == "vehicle" && i < has_modem_.size() && !has_modem_[i];
      KeyChanger inner(changes_, has_modem_, path_ + std::string(key) + ".", without_modem);
      item(inner, i);
    }
  }
  // All values are in memory, but a vehicle without a modem of its own is to remain so.
  bool given(std::string_view key) const override { return !(without_modem_ && key == "modem"); }
  bool is_text(std::string_view) const override { return false; }
  bool writing() const override { return true; }
  void problem(std::string_view, std::string_view) override {}
  void shared_with_others() override {}

 private:
  bool names(const KeyChange& change, std::string_view key) const {
    return change.key.size() == path_.size() + key.size() && change.key.starts_with(path_) &&
           change.key.ends_with(key);
  }

  const std::vector<KeyChange>& changes_;
  const std::vector<bool>& has_modem_;
  std::string path_;
  bool without_modem_;
};

}  // namespace

KeyChange scaled(const std::string& key, double factor) {
  return {key, [factor](double value) { return value * factor; }};
}

KeyChange added(const std::string& key, double term) {
  return {key, [term](double value) { return value + term; }};
}

KeyChange set_to(const std::string& key, double value) {
  return {key, [value](double) { return value; }};
}

void change_keys(ChannelServerConfig& config, const std::vector<KeyChange>& changes) {
  std::vector<bool> has_modem;
  for (const auto& vehicle : config.vehicles) has_modem.push_back(vehicle.has_modem);
  KeyChanger changer(changes, has_modem);
  visit(changer, config);
}

std::optional<double> number_of_key(const ChannelServerConfig& config, const std::string& key) {
  std::optional<double> found;
  const auto note = [&](double value) {
    if (!found) found = value;
    return value;
  };
  ChannelServerConfig copy = config;
  change_keys(copy, {{key, note}});
  return found;
}

}  // namespace halocline::clients
