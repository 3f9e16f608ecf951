// SPDX-License-Identifier: BSD-3-Clause
// Parameters of the agents node, phy and uwlink, with their meaning in the simulation.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "clients/modem_gateway/protocols/unet/unet_json.h"

namespace halocline::modem_gateway {

// The two channels of a modem, CONTROL and DATA, with the parameters of models/modems/unet-control.toml and
// unet-data.toml.
inline constexpr int kUnetControl = 1, kUnetData = 2;
struct UnetChannel {
  double data_rate_bps;
  std::int64_t frame_bytes;
  double overhead_s;
  const char* modulation;

  double frame_duration_s() const {
    return overhead_s + 8 * static_cast<double>(frame_bytes) / data_rate_bps;
  }
};
// Returns the channel `index`: kUnetControl or kUnetData.
const UnetChannel& unet_channel(int index);

class UnetParameters {
 public:
  // Parameters of the modem interface of `context`, whose references must outlive it.
  explicit UnetParameters(const ProtocolContext& context);

  // Returns the answer to a ParameterReq, a ParameterRsp or NOT_UNDERSTOOD, as fields with the class under
  // "clazz".
  nlohmann::json answer(const UnetRequest& request);

  double sound_speed_mps() const { return sound_speed_mps_; }
  // Returns the source level of a channel, dB re 1 uPa at 1 m; nothing unless a host has set it.
  std::optional<double> source_level_db(int index) const {
    return levels_.at(static_cast<std::size_t>(index));
  }
  bool receives() const { return receives_; }
  void note_noise(double level_db) { noise_db_ = level_db; }
  void note_busy(bool busy) { is_busy_ = busy; }

 private:
  // Returns the value of a parameter; null when there is none.
  nlohmann::json value(const std::string& agent, std::int64_t index, const std::string& name) const;
  nlohmann::json node_value(const std::string& name) const;
  nlohmann::json channel_value(int index, const std::string& name) const;
  nlohmann::json phy_value(const std::string& name) const;
  bool set(const std::string& agent, std::int64_t index, const std::string& name,
           const nlohmann::json& value);

  ProtocolPort& port_;
  AddressBook& addresses_;
  std::int32_t vehicle_id_;
  std::string name_;
  double latitude_deg_, longitude_deg_;
  double sound_speed_mps_ = 1500;
  std::array<std::optional<double>, 3> levels_;  // key: index of the channel
  bool receives_ = true, is_busy_ = false;
  double noise_db_ = 0;
};

}  // namespace halocline::modem_gateway
