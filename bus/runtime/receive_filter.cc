#include "bus/runtime/receive_filter.h"

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <system_error>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "bus/channel_pattern.h"
#include "bus/channels.h"
#include "bus/transport.h"

namespace halocline::bus {
namespace {

// A datagram as the filter sees it: 8 bytes of UDP, then LCM's word for a short message, its sequence number, the
// channel with a 0 behind it, the message (liblcm, udpm_util.h: lcm2_header_short_t).
constexpr std::uint32_t kWordAt = 8, kChannelAt = 16;
constexpr std::uint32_t kShortMessage = 0x4c433032;  // "LC02"
constexpr std::uint32_t kPass = 0xffffffff, kLeaveOut = 0;
constexpr std::size_t kMaxInstructions = 2048;  // the kernel takes 4096

sock_filter statement(unsigned code, std::uint32_t value) {
  return {static_cast<std::uint16_t>(code), 0, 0, value};
}

sock_filter jump(unsigned code, std::uint32_t value, std::size_t if_true, std::size_t if_false) {
  return {static_cast<std::uint16_t>(BPF_JMP | code | BPF_K), static_cast<std::uint8_t>(if_true),
          static_cast<std::uint8_t>(if_false), value};
}

std::uint32_t number_at(std::string_view text, std::size_t at, std::size_t bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i) value = value << 8 | static_cast<std::uint8_t>(text[at + i]);
  return value;
}

// Passes datagrams whose channel begins with `text`; others fall through.
void append_comparison(std::string_view text, std::vector<sock_filter>& program) {
  std::vector<sock_filter> steps;
  const auto end = static_cast<std::uint32_t>(kChannelAt + text.size());
  steps.push_back(statement(BPF_LD | BPF_W | BPF_LEN, 0));
  steps.push_back(jump(BPF_JGE, end, 0, 0));
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t left = text.size() - at, bytes = left >= 4 ? 4 : left >= 2 ? 2 : 1;
    const unsigned size = bytes == 4 ? BPF_W : bytes == 2 ? BPF_H : BPF_B;
    steps.push_back(statement(BPF_LD | size | BPF_ABS, static_cast<std::uint32_t>(kChannelAt + at)));
    steps.push_back(jump(BPF_JEQ, number_at(text, at, bytes), 0, 0));
    at += bytes;
  }
  for (std::size_t i = 1; i < steps.size(); i += 2) steps[i].jf = static_cast<std::uint8_t>(steps.size() - i);
  steps.push_back(statement(BPF_RET | BPF_K, kPass));
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

// LCM does not tell its socket. -1 unless exactly one of the process is bound to the port.
int find_socket(std::uint16_t port) {
  std::vector<int> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", error)) {
    const int socket = std::stoi(entry.path().filename().string());
    if (is_bound_to(socket, port)) found.push_back(socket);
  }
  return found.size() == 1 ? found[0] : -1;
}

}  // namespace

std::vector<sock_filter> receive_program(const std::multiset<std::string>& expressions) {
  std::set<std::string> texts;
  for (const std::string& expression : expressions) {
    const ChannelPattern pattern(expression);
    std::string text(pattern.only_prefix());
    if (!pattern.only_channel().empty()) text = std::string(pattern.only_channel()) + '\0';
    if (text.empty()) return {};
    texts.insert(text);
    texts.insert(channels::kRepair.of(text));
  }
  std::vector<sock_filter> program{statement(BPF_LD | BPF_W | BPF_ABS, kWordAt),
                                   jump(BPF_JEQ, kShortMessage, 1, 0), statement(BPF_RET | BPF_K, kPass)};
  for (const std::string& text : texts) append_comparison(text, program);
  program.push_back(statement(BPF_RET | BPF_K, kLeaveOut));
  return program.size() <= kMaxInstructions ? program : std::vector<sock_filter>();
}

ReceiveFilter::ReceiveFilter(lcm::LCM& lcm, const std::string& url) {
  const auto port = port_of(url);
  if (!port || !url.starts_with("udpm://")) return;
  lcm.getFileno();  // begins to receive
  socket_ = find_socket(*port);
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

// Without a filter, or where the kernel refuses it, LCM itself discards what nobody wants.
void ReceiveFilter::attach(const std::multiset<std::string>& expressions) {
  std::vector<sock_filter> program = receive_program(expressions);
  const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
  const int none = 0;
  if (program.empty() || setsockopt(socket_, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter) != 0)
    setsockopt(socket_, SOL_SOCKET, SO_DETACH_FILTER, &none, sizeof none);
}

}  // namespace halocline::bus
