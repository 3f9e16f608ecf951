// SPDX-License-Identifier: BSD-3-Clause
// Hosts of a UnetStack gateway: answers fjage requests about agents, services and subscriptions, passes on
// messages to agents, and sends messages to the hosts that want them.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "clients/modem_gateway/protocols/line_reader.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "clients/modem_gateway/protocols/unet/unet_json.h"

namespace halocline::modem_gateway {

class UnetHosts {
 public:
  using OnRequest = std::function<void(const UnetRequest&)>;

  // `on_request` receives the messages to one of the agents.
  UnetHosts(ProtocolPort& port, OnRequest on_request) : port_(port), on_request_(std::move(on_request)) {}

  void open(ClientId client);
  void close(ClientId client) { hosts_.erase(client); }
  void take(ClientId client, std::string_view bytes);

  // Sends an agent's answer to a request; `fields` contains the class of the message under "clazz".
  void answer(const UnetRequest& request, nlohmann::json fields);
  void refuse(const UnetRequest& request, const std::string& reason);
  // Sends a notification about a request to the host that made it.
  void reply(const UnetRequest& request, const std::string& clazz, nlohmann::json fields);
  // Sends a notification to a topic.
  void notify(const std::string& topic, const std::string& clazz, nlohmann::json fields);

 private:
  struct Host {
    LineReader reader{LineReader::kMaxJson};
    std::set<std::string> wants;  // recipients whose messages it gets; empty: all
  };

  void take_line(ClientId client, std::string_view line);
  void refuse_long_line(ClientId client, std::string_view beginning, std::string_view end);
  nlohmann::json answer_to(Host& host, const nlohmann::json& request);
  void publish(const std::string& clazz, nlohmann::json data);

  ProtocolPort& port_;
  OnRequest on_request_;
  std::map<ClientId, Host> hosts_;
  std::int64_t messages_ = 0;
};

}  // namespace halocline::modem_gateway
