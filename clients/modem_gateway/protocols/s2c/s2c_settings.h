// SPDX-License-Identifier: BSD-3-Clause
// Commands of an EvoLogics modem that set, query and reset: !, @, ?, &, Z, I and others.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "clients/modem_gateway/protocols/s2c/s2c_core.h"
#include "clients/modem_gateway/protocols/s2c/s2c_reader.h"
#include "clients/modem_gateway/protocols/s2c/s2c_sender.h"

namespace halocline::modem_gateway {

class S2cSettings {
 public:
  // `core` and `sender` must outlive it. `on_stored` is called when the modem's non-volatile memory has
  // changed.
  S2cSettings(S2cCore& core, S2cSender& sender, std::function<void()> on_stored)
      : core_(core), sender_(sender), on_stored_(std::move(on_stored)) {}

  // Returns the body of the answer; nothing for a command that belongs to another part.
  std::optional<std::string> answer(const S2cCommand& command);
  // Stores the last position measured by the USBL, for ?UP.
  void note_position(std::string position) { position_ = std::move(position); }

 private:
  std::string set(const S2cCommand& command);
  std::optional<std::string> query(const std::string& name) const;
  std::string all_settings() const;
  std::string status() const;
  double battery_v() const;

  S2cCore& core_;
  S2cSender& sender_;
  std::function<void()> on_stored_;
  std::string position_;
};

}  // namespace halocline::modem_gateway
