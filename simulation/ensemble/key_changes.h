// SPDX-License-Identifier: BSD-3-Clause
// Changes of a configuration that was read, by the names of its keys: of the water, the propagation and the
// modems.
//
// Keys are named as in a scenario, with their sections and without indices of lists: "propagation.sediment",
// "modem.receiver_loss_db". What is changed in [modem] is to be changed in "vehicle.modem", too, for vehicles
// with modems of their own. A number that leaves the range of its key ends at its bound.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "channel_server/channel_server_config.h"

namespace halocline::clients {

// One change; of `number` and `text` the one that fits the key is used.
struct KeyChange {
  std::string key;
  std::function<double(double)> number = {};
  // `allowed` lists the texts that the key may have, in the order of its description.
  std::function<std::string(const std::string&, const std::vector<std::string>& allowed)> text = {};
};

KeyChange scaled(const std::string& key, double factor);
KeyChange added(const std::string& key, double term);
KeyChange set_to(const std::string& key, double value);

// Makes all changes, each of them once at every place of its key. Keys that the program does not have are no
// error.
void change_keys(channel_server::ChannelServerConfig& config, const std::vector<KeyChange>& changes);

// Returns the number that a key has, at its first place; empty when there is no such key.
std::optional<double> number_of_key(const channel_server::ChannelServerConfig& config,
                                    const std::string& key);

}  // namespace halocline::clients
