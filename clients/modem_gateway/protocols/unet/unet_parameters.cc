// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/unet/unet_parameters.h"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

namespace halocline::modem_gateway {
namespace {

using nlohmann::json;

constexpr std::array<UnetChannel, 2> kChannels{{{800, 16, 0.1, "fhbfsk"}, {2400, 64, 0.1, "ofdm"}}};
constexpr double kSourceLevel_db = 185;
constexpr std::int64_t kHighestAddress = 254;

const std::vector<std::string> kNodeNames{"address", "nodeName", "version", "origin", "location", "title"};
const std::vector<std::string> kPhyNames{
    "MTU", "RTU", "time", "busy", "rxEnable", "propagationSpeed", "signalPowerLevel", "noise", "title"};
const std::vector<std::string> kChannelNames{"dataRate", "frameDuration", "frameLength", "powerLevel",
                                             "fec",      "modulation",    "MTU",         "RTU"};
const std::vector<std::string> kLinkNames{"MTU", "RTU", "title"};

const std::vector<std::string>& names_of(const std::string& agent, std::int64_t index) {
  static const std::vector<std::string> kNone{"title"};
  if (agent == "node") return kNodeNames;
  if (agent == "phy") return index > 0 ? kChannelNames : kPhyNames;
  return agent == "uwlink" ? kLinkNames : kNone;
}

// Returns true for the parameters that hosts may set; all others are read-only.
bool is_settable(const std::string& name) {
  constexpr std::array<std::string_view, 4> kSettable{"address", "rxEnable", "propagationSpeed",
                                                      "powerLevel"};
  return std::find(kSettable.begin(), kSettable.end(), name) != kSettable.end();
}

std::int64_t mtu_of(int index) { return unet_channel(index).frame_bytes; }

}  // namespace

const UnetChannel& unet_channel(int index) { return kChannels.at(static_cast<std::size_t>(index - 1)); }

UnetParameters::UnetParameters(const ProtocolContext& context)
    : port_(context.port),
      addresses_(context.addresses),
      vehicle_id_(context.vehicle_id),
      name_(context.vehicle_name()),
      latitude_deg_(context.origin_latitude_deg),
      longitude_deg_(context.origin_longitude_deg) {}

json UnetParameters::node_value(const std::string& name) const {
  if (name == "address") return addresses_.address_of(vehicle_id_).value_or(0);
  if (name == "nodeName") return name_;
  if (name == "version") return "5.2.0";
  if (name == "title") return "Node information";
  if (name == "origin") return json{latitude_deg_, longitude_deg_};
  if (name != "location") return nullptr;
  const vehicle_state_t* state = port_.state();
  if (state == nullptr) return json{0.0, 0.0, 0.0};
  return json{state->position_ned_m[1], state->position_ned_m[0], -state->position_ned_m[2]};
}

json UnetParameters::channel_value(int index, const std::string& name) const {
  const UnetChannel& channel = unet_channel(index);
  if (name == "dataRate") return channel.data_rate_bps;
  if (name == "frameDuration") return channel.frame_duration_s();
  if (name == "frameLength") return channel.frame_bytes;
  if (name == "powerLevel") return source_level_db(index).value_or(kSourceLevel_db);
  if (name == "fec") return 0;
  if (name == "modulation") return channel.modulation;
  return name == "MTU" || name == "RTU" ? json(mtu_of(index)) : json();
}

json UnetParameters::phy_value(const std::string& name) const {
  if (name == "MTU" || name == "RTU") return mtu_of(kUnetData);
  if (name == "time") return port_.clock_at(port_.now()).to_utime();
  if (name == "busy") return is_busy_;
  if (name == "rxEnable") return receives_;
  if (name == "propagationSpeed") return sound_speed_mps_;
  if (name == "signalPowerLevel") return source_level_db(kUnetData).value_or(kSourceLevel_db);
  if (name == "noise") return noise_db_;
  return name == "title" ? json("Physical layer") : json();
}

json UnetParameters::value(const std::string& agent, std::int64_t index, const std::string& name) const {
  if (agent == "node") return node_value(name);
  if (agent == "phy" && (index == kUnetControl || index == kUnetData))
    return channel_value(static_cast<int>(index), name);
  if (agent == "phy" && index < 0) return phy_value(name);
  if (agent == "uwlink" && (name == "MTU" || name == "RTU")) return mtu_of(kUnetData);
  return name == "title" ? json(agent) : json();
}

bool UnetParameters::set(const std::string& agent, std::int64_t index, const std::string& name,
                         const json& value) {
  if (agent == "node" && name == "address" && value.is_number_integer()) {
    const auto address = value.get<std::int64_t>();
    if (address < 1 || address > kHighestAddress) return false;
    addresses_.assign(vehicle_id_, static_cast<std::int32_t>(address));
    return true;
  }
  if (agent != "phy") return false;
  if (name == "rxEnable" && value.is_boolean()) {
    receives_ = value.get<bool>();
    return true;
  }
  if (!value.is_number()) return false;
  const double number = value.get<double>();
  if (name == "propagationSpeed" && number >= 1300 && number <= 1700) {
    sound_speed_mps_ = number;
    return true;
  }
  const bool is_level = name == "powerLevel" && (index == kUnetControl || index == kUnetData);
  if (!is_level || !(number >= 0 && number <= 250)) return false;
  levels_[static_cast<std::size_t>(index)] = number;
  return true;
}

// The first parameter is in `param` and `value`, further ones in `values`. A value that cannot be set is
// ignored, and the answer contains the present one.
json UnetParameters::answer(const UnetRequest& request) {
  const std::int64_t index = integer_of(request.data, "index", -1);
  std::vector<std::pair<std::string, json>> asked;  // names, with the values to set
  const auto add = [&](const json& one) {
    if (const std::string name = text_of(one, "param"); !name.empty())
      asked.emplace_back(name, one.contains("value") ? one["value"] : json());
  };
  add(request.data);
  if (const auto more = request.data.find("requests"); more != request.data.end() && more->is_array()) {
    for (const json& one : *more) {
      if (one.is_object()) add(one);
    }
  }
  if (asked.empty()) {
    for (const std::string& name : names_of(request.recipient, index)) asked.emplace_back(name, json());
  }
  const bool is_old = request.clazz == "org.arl.unet.ParameterReq";
  json answer{{"clazz", is_old ? "org.arl.unet.ParameterRsp" : "org.arl.fjage.param.ParameterRsp"},
              {"perf", "INFORM"},
              {"index", index},
              {"values", json::object()},
              {"readonly", json::array()}};
  for (const auto& [name, wanted] : asked) {
    const std::string own = name.substr(name.rfind('.') + 1);
    if (!wanted.is_null()) set(request.recipient, index, own, wanted);
    const json now = value(request.recipient, index, own);
    if (now.is_null()) return {{"clazz", "org.arl.fjage.Message"}, {"perf", "NOT_UNDERSTOOD"}};
    if (!is_settable(own)) answer["readonly"].push_back(name);
    if (answer.contains("param")) {
      answer["values"][name] = now;
    } else {
      answer["param"] = name;
      answer["value"] = now;
    }
  }
  return answer;
}

}  // namespace halocline::modem_gateway
