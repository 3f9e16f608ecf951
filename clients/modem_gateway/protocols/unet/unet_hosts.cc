// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/unet/unet_hosts.h"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <fmt/format.h>

namespace halocline::modem_gateway {
namespace {

using nlohmann::json;

// Exact text: clients compare it byte by byte.
constexpr std::string_view kAlive = "{\"alive\": true}\n";
constexpr std::size_t kMaxWants = 1000;

struct Agent {
  const char* name;
  const char* type;
};
constexpr std::array<Agent, 5> kAgents{{{"node", "org.arl.unet.nodeinfo.NodeInfo"},
                                        {"arp", "org.arl.unet.addr.AddressResolution"},
                                        {"phy", "org.arl.unet.phy.Physical"},
                                        {"ranging", "org.arl.unet.localization.Ranging"},
                                        {"uwlink", "org.arl.unet.link.ECLink"}}};
// Services and their agents. For one service with several agents the first is preferred.
struct Service {
  const char* name;
  const char* agent;
};
constexpr std::array<Service, 7> kServices{{{"NODE_INFO", "node"},
                                            {"ADDRESS_RESOLUTION", "arp"},
                                            {"PHYSICAL", "phy"},
                                            {"LINK", "uwlink"},
                                            {"DATAGRAM", "uwlink"},
                                            {"DATAGRAM", "phy"},
                                            {"RANGING", "ranging"}}};
constexpr std::string_view kServicePrefix = "org.arl.unet.Services.";

std::vector<std::string> agents_for(const std::string& service) {
  std::vector<std::string> agents;
  for (const Service& each : kServices) {
    if (service == std::string(kServicePrefix) + each.name || service == each.name)
      agents.emplace_back(each.agent);
  }
  return agents;
}

bool is_agent(const std::string& name) {
  for (const Agent& agent : kAgents) {
    if (name == agent.name) return true;
  }
  return false;
}

json all_services() {
  std::set<std::string> names;
  for (const Service& service : kServices) names.insert(std::string(kServicePrefix) + service.name);
  return names;
}

}  // namespace

void UnetHosts::open(ClientId client) {
  hosts_[client];
  port_.write(client, kAlive);
}

void UnetHosts::take(ClientId client, std::string_view bytes) {
  hosts_[client].reader.take(
      bytes, [&](std::string_view line) { take_line(client, line); },
      [&] { port_.note("line-too-long", "client=" + std::to_string(client)); },
      [&](std::string_view beginning, std::string_view end) { refuse_long_line(client, beginning, end); });
}

// The fields that name the request may be before or after its data, because JSON does not order them.
void UnetHosts::refuse_long_line(ClientId client, std::string_view beginning, std::string_view end) {
  const auto text = [&](const char* name) {
    json value = value_in_piece(beginning, name);
    if (!value.is_string()) value = value_in_piece(end, name);
    return value.is_string() ? value.get<std::string>() : std::string();
  };
  UnetRequest request;
  request.id = text("msgID");
  request.sender = text("sender");
  request.recipient = text("recipient");
  if (request.id.empty()) return port_.disconnect(client);
  refuse(request, fmt::format("request longer than {} bytes", LineReader::kMaxJson));
}

void UnetHosts::take_line(ClientId client, std::string_view line) {
  const json request = json_of(line);
  if (!request.is_object()) return port_.note("no-json", "client=" + std::to_string(client));
  if (text_of(request, "action") == "send") {
    const auto message = request.contains("message") ? unet_request(request["message"]) : std::nullopt;
    if (!message) return port_.note("no-message", "client=" + std::to_string(client));
    if (is_agent(message->recipient)) return on_request_(*message);
    if (message->type.ends_with("Req") && !message->recipient.starts_with('#'))
      refuse(*message, "no agent " + message->recipient);
    return;
  }
  json answer = answer_to(hosts_[client], request);
  if (answer.is_null()) return;
  answer["inResponseTo"] = request["action"];
  if (request.contains("id")) answer["id"] = request["id"];
  port_.write(client, answer.dump() + "\n");
}

// Returns null when no answer is due.
json UnetHosts::answer_to(Host& host, const json& request) {
  const std::string action = text_of(request, "action");
  if (action == "agents") {
    json names = json::array(), types = json::array();
    for (const Agent& agent : kAgents) names.push_back(agent.name), types.push_back(agent.type);
    return {{"agentIDs", names}, {"agentTypes", types}};
  }
  if (action == "containsAgent") return {{"answer", is_agent(text_of(request, "agentID"))}};
  if (action == "services") return {{"services", all_services()}};
  const auto agents = agents_for(text_of(request, "service"));
  if (action == "agentForService") return agents.empty() ? json::object() : json{{"agentID", agents.front()}};
  if (action == "agentsForService") return {{"agentIDs", agents}};
  if (action == "auth") return {{"auth", true}};
  // Any other request with an id is answered, even one that fjage does not define.
  if (action != "wantsMessagesFor") return request.contains("id") ? json::object() : json();
  if (!request.contains("agentIDs") || !request["agentIDs"].is_array()) return nullptr;
  host.wants.clear();
  for (const json& name : request["agentIDs"]) {
    if (name.is_string() && host.wants.size() < kMaxWants) host.wants.insert(name.get<std::string>());
  }
  return nullptr;
}

void UnetHosts::answer(const UnetRequest& request, json fields) {
  const std::string clazz = text_of(fields, "clazz");
  fields.erase("clazz");
  reply(request, clazz, std::move(fields));
}

void UnetHosts::refuse(const UnetRequest& request, const std::string& reason) {
  reply(request, "org.arl.unet.RefuseRsp", {{"perf", "REFUSE"}, {"reason", reason}});
}

void UnetHosts::reply(const UnetRequest& request, const std::string& clazz, json fields) {
  fields["inReplyTo"] = request.id;
  fields["sender"] = request.recipient;
  fields["recipient"] = request.sender;
  publish(clazz, std::move(fields));
}

void UnetHosts::notify(const std::string& topic, const std::string& clazz, json fields) {
  fields["recipient"] = topic;
  publish(clazz, std::move(fields));
}

void UnetHosts::publish(const std::string& clazz, json data) {
  if (!data.contains("perf")) data["perf"] = "INFORM";
  data["msgID"] = fmt::format("halocline-{:016x}", ++messages_);
  const std::string recipient = text_of(data, "recipient");
  const std::string line =
      json{{"action", "send"}, {"message", {{"clazz", clazz}, {"data", std::move(data)}}}, {"relay", false}}
          .dump(-1, ' ', false, json::error_handler_t::replace) +
      "\n";
  for (const auto& [client, host] : hosts_) {
    if (host.wants.empty() || host.wants.contains(recipient)) port_.write(client, line);
  }
}

}  // namespace halocline::modem_gateway
