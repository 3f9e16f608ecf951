// SPDX-License-Identifier: BSD-3-Clause
#include "bus/transport/receive_filter.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>

#include <arpa/inet.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "bus/messages/channel_pattern.h"
#include "bus/messages/channels.h"
#include "bus/transport/transport.h"
#include "core/check.h"

namespace halocline::bus {
namespace {

constexpr std::size_t kMaxInstructions = 2048;  // limit for channels; the kernel's is 4096 in all

std::uint32_t number_at(std::string_view text, std::size_t at, std::size_t bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i) value = value << 8 | static_cast<std::uint8_t>(text[at + i]);
  return value;
}

// Appends a comparison that passes datagrams whose channel is `text` with its terminating 0. If `text` has no
// 0, the last statement is a jump, taken for channels that begin with `text`. Other datagrams continue after
// it.
void append_comparison(std::string_view text, FilterProgram& program) {
  FilterProgram steps;
  const auto end = static_cast<std::uint32_t>(kShortChannelAt + text.size());
  steps.push_back(filter_statement(BPF_LD | BPF_W | BPF_LEN, 0));
  steps.push_back(filter_jump(BPF_JGE, end, 0, 0));
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t left = text.size() - at, bytes = left >= 4 ? 4 : left >= 2 ? 2 : 1;
    const unsigned size = bytes == 4 ? BPF_W : bytes == 2 ? BPF_H : BPF_B;
    steps.push_back(
        filter_statement(BPF_LD | size | BPF_ABS, static_cast<std::uint32_t>(kShortChannelAt + at)));
    steps.push_back(filter_jump(BPF_JEQ, number_at(text, at, bytes), 0, 0));
    at += bytes;
  }
  for (std::size_t i = 1; i < steps.size(); i += 2) steps[i].jf = static_cast<std::uint8_t>(steps.size() - i);
  const bool is_whole = text.back() == '\0';
  steps.push_back(is_whole ? filter_statement(BPF_RET | BPF_K, kFilterPasses)
                           : filter_statement(BPF_JMP | BPF_JA, 0));
  program.insert(program.end(), steps.begin(), steps.end());
}

bool is_bound_to(int socket, std::uint16_t port) {
  int type = 0;
  socklen_t size = sizeof type;
  if (getsockopt(socket, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_DGRAM) return false;
  sockaddr_in address{};
  size = sizeof address;
  return getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) == 0 &&
         address.sin_family == AF_INET && ntohs(address.sin_port) == port;
}

// Returns the sockets of the process that are bound to the port; LCM does not reveal its own.
std::vector<int> sockets_at(std::uint16_t port) {
  std::vector<int> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", error)) {
    const int socket = std::stoi(entry.path().filename().string());
    if (is_bound_to(socket, port)) found.push_back(socket);
  }
  return found;
}

std::vector<int> receiving_sockets(lcm::LCM& lcm, const std::string& url) {
  const auto port = port_of(url);
  if (!port || !url.starts_with("udpm://")) return {};
  lcm.getFileno();  // makes LCM open its socket
  return sockets_at(*port);
}

// Filter for short messages: passes those whose channel is in `expressions`, drops those that match nothing,
// and continues after its end for those that begin with a prefix. Empty if every channel has to pass.
FilterProgram channel_program(const std::multiset<std::string>& expressions) {
  std::set<std::string> texts;
  for (const std::string& expression : expressions) {
    const ChannelPattern pattern(expression);
    std::string text(pattern.only_prefix());
    if (!pattern.only_channel().empty()) text = std::string(pattern.only_channel()) + '\0';
    if (text.empty()) return {};
    texts.insert(text);
    texts.insert(channels::kRepair.of(text));
  }
  FilterProgram program;
  for (const std::string& text : texts) append_comparison(text, program);
  program.push_back(filter_statement(BPF_RET | BPF_K, kFilterDrops));
  for (std::size_t i = 0; i < program.size(); ++i) {
    if (program[i].code == (BPF_JMP | BPF_JA))
      program[i].k = static_cast<std::uint32_t>(program.size() - i - 1);
  }
  return program.size() <= kMaxInstructions ? program : FilterProgram();
}

// Filter that continues after its end for accepted hosts and drops others. Empty if any host is accepted.
FilterProgram host_program(const AcceptedHosts& hosts) {
  constexpr std::uint32_t kPacketType = SKF_AD_OFF + SKF_AD_PKTTYPE, kInterface = SKF_AD_OFF + SKF_AD_IFINDEX;
  constexpr std::uint32_t kSource = SKF_NET_OFF + 12;  // source address in the IP header
  if (hosts.any) return {};
  FilterProgram program;
  std::vector<std::size_t> ways_on;
  const auto go_on_if = [&](std::uint32_t value) {
    program.push_back(filter_jump(BPF_JEQ, value, 0, 1));
    ways_on.push_back(program.size());
    program.push_back(filter_statement(BPF_JMP | BPF_JA, 0));
  };
  program.push_back(filter_statement(BPF_LD | BPF_W | BPF_ABS, kPacketType));
  go_on_if(PACKET_LOOPBACK);  // multicast of this host
  program.push_back(filter_statement(BPF_LD | BPF_W | BPF_ABS, kInterface));
  go_on_if(if_nametoindex("lo"));
  for (const AcceptedHosts::Range& range : hosts.ranges) {
    program.push_back(filter_statement(BPF_LD | BPF_W | BPF_ABS, kSource));
    program.push_back(filter_statement(BPF_ALU | BPF_AND | BPF_K, range.mask));
    go_on_if(range.address & range.mask);
  }
  program.push_back(filter_statement(BPF_RET | BPF_K, kFilterDrops));
  for (const std::size_t way : ways_on) program[way].k = static_cast<std::uint32_t>(program.size() - way - 1);
  return program;
}

// Parses "10.0.3.7" or "10.0.3.0/24".
AcceptedHosts::Range range_of(const std::string& word) {
  constexpr std::size_t kMaxBits = 32;
  const std::string trimmed = word.substr(0, word.find_last_not_of(' ') + 1);
  const std::size_t slash = trimmed.find('/');
  const std::string bits_text = slash == std::string::npos ? "32" : trimmed.substr(slash + 1);
  in_addr address{};
  const bool has_address = inet_pton(AF_INET, trimmed.substr(0, slash).c_str(), &address) == 1;
  const bool has_bits = !bits_text.empty() && bits_text.size() <= 2 &&
                        bits_text.find_first_not_of("0123456789") == std::string::npos;
  const std::size_t bits = has_bits ? std::stoul(bits_text) : kMaxBits + 1;
  require(has_address && bits <= kMaxBits, "'" + trimmed +
                                               "' is no host; allowed are any, addresses as 10.0.3.7 and "
                                               "ranges as 10.0.3.0/24, with commas between them");
  const std::uint64_t ones = 0xffffffffu;
  return {ntohl(address.s_addr), static_cast<std::uint32_t>(ones << (kMaxBits - bits))};
}

}  // namespace

AcceptedHosts accepted_hosts(const std::string& text, const std::string& url) {
  const std::size_t ttl = url.find("ttl=");  // LCM's default is 0
  const bool leaves_host = ttl != std::string::npos && !url.substr(ttl).starts_with("ttl=0");
  if (text == "any" || (text.empty() && leaves_host)) return {};
  AcceptedHosts hosts{.any = false, .ranges = {}};
  std::istringstream words(text);
  for (std::string word; std::getline(words >> std::ws, word, ',');) hosts.ranges.push_back(range_of(word));
  return hosts;
}

FilterProgram receive_program(const std::multiset<std::string>& expressions, const AcceptedHosts& hosts) {
  return datagram_program(host_program(hosts), channel_program(expressions));
}

int receive_socket(lcm::LCM& lcm, const std::string& url) {
  const std::vector<int> sockets = receiving_sockets(lcm, url);
  return sockets.size() == 1 ? sockets[0] : -1;
}

ReceiveFilter::ReceiveFilter(lcm::LCM& lcm, const std::string& url, AcceptedHosts hosts)
    : hosts_(std::move(hosts)) {
  const std::vector<int> sockets = receiving_sockets(lcm, url);
  const FilterProgram for_all = receive_program({".*"}, hosts_);
  const bool is_network =
      url.starts_with("udpm://") && lcm.getFileno() >= 0;  // otherwise there is nothing to receive
  bool is_attached = !sockets.empty() || !is_network;
  for (const int socket : sockets) is_attached = attach_filter(socket, for_all) && is_attached;
  if (!is_attached) warn_of_missing_filter();
  if (sockets.size() == 1) socket_ = sockets[0];
}

void ReceiveFilter::follow(const Subscriptions* first, const Subscriptions* second) {
  if (socket_ < 0) return;
  const auto count = [](const Subscriptions* one) { return one == nullptr ? 0 : one->changes() + 1; };
  const std::array changes = {count(first), count(second)};
  if (changes_ == changes) return;
  changes_ = changes;
  std::multiset<std::string> expressions;
  for (const Subscriptions* one : {first, second}) {
    if (one != nullptr) expressions.insert(one->expressions().begin(), one->expressions().end());
  }
  attach(expressions);
}

// The kernel grants a socket some memory for filters (net.core.optmem_max, 20 kB before Linux 6.7), and the
// previous filter occupies part of it until it is replaced. If the new filter does not fit, the previous one
// is replaced first by a filter that drops everything, for some microseconds. If there are too many channels,
// LCM itself discards unwanted messages.
void ReceiveFilter::attach(const std::multiset<std::string>& expressions) {
  const FilterProgram program = receive_program(expressions, hosts_);
  if (attach_filter(socket_, program)) return;
  std::ignore = attach_filter(socket_, {filter_statement(BPF_RET | BPF_K, kFilterDrops)});
  if (!attach_filter(socket_, program)) std::ignore = attach_filter(socket_, receive_program({".*"}, hosts_));
}

}  // namespace halocline::bus
