// SPDX-License-Identifier: BSD-3-Clause
// Datagrams to the socket of a living LCM, behind the filter of our transport, whose Bus takes every
// message: any bytes, and fragments made of numbers near what they hold. The bus is this network
// namespace's (scripts/isolated).
#include <array>
#include <cstdint>
#include <memory>
#include <numeric>
#include <string>
#include <string_view>

#include <lcm/lcm-cpp.hpp>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "bus/bus.h"
#include "bus/transport/datagram_filter.h"
#include "bus/transport/event_log.h"
#include "bus/transport/transport.h"
#include "core/check.h"
#include "tests/fuzz/fuzz_input.h"

namespace {

using namespace halocline;

constexpr std::uint16_t kPort = 7703;
constexpr std::string_view kDone = "FUZZ_DONE";
constexpr int kMaxDatagrams = 32;  // the socket's buffer holds them all

std::string big_endian(std::uint32_t value, int bytes) {
  std::string text;
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) text += static_cast<char>(value >> shift);
  return text;
}

// Sender with an address of its own: no other input goes on with what it leaves unfinished.
class Sender {
 public:
  Sender() {
    const int ttl = 0;
    setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
  }
  ~Sender() { close(socket_); }
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;
  void send(const std::string& datagram) const {
    const sockaddr_in group{AF_INET, htons(kPort), {htonl(0xefff4c43)}, {}};
    sendto(socket_, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&group),
           sizeof group);
  }

 private:
  int socket_ = socket(AF_INET, SOCK_DGRAM, 0);
};

class Receiver {
 public:
  Receiver() {
    bus_.subscribe_to_all([this](std::string_view channel, const void* data, std::size_t size) {
      ensure(size <= bus::kMaxMessageBytes, "no message is larger than the largest");
      const auto* bytes = static_cast<const std::uint8_t*>(data);
      sum_ = std::accumulate(bytes, bytes + size, sum_);  // reads each
      done_ = done_ || channel == kDone;
    });
  }
  // Until all that was sent before has been read.
  void catch_up(const Sender& sender) {
    done_ = false;
    for (int i = 0; !done_; ++i) {
      ensure(i < 100, "LCM goes on reading");
      sender.send("LC02" + big_endian(0, 4) + std::string(kDone) + std::string(1, 0));
      while (!done_ && lcm_->handleTimeout(200) > 0) {
      }
      bus_.rethrow_if_failed();
    }
  }

 private:
  std::unique_ptr<lcm::LCM> lcm_ =
      bus::open_transport("udpm://239.255.76.67:" + std::to_string(kPort) + "?ttl=0&recv_buf_size=4194304");
  bus::Bus bus_{*lcm_, {"receiver", 1}};
  std::uint64_t sum_ = 0;
  bool done_ = false;
};

std::string fragment_from(fuzz::Input& input) {
  const auto flags = input.number();
  std::string part = (flags & 1) != 0 ? std::string("STATE.a") : std::string();
  if ((flags & 2) != 0) part += '\0';
  part += input.text_block();
  if ((flags & 4) != 0) part.resize(part.size() + 256 * std::size_t{input.number()}, 'x');
  const auto length = static_cast<std::uint32_t>(part.size());
  const auto count = input.number(), number = input.number();
  const std::array<std::uint32_t, 8> sizes{length,   length - 8, 2 * length, 1024, bus::kMaxMessageBytes,
                                           1u << 28, 0xffffffff, 0};
  std::uint32_t size = sizes[input.below(8)];
  if ((flags & 8) != 0) size += input.number<std::int8_t>();
  const std::array<std::uint32_t, 8> offsets{0,           size - length, length,   size,
                                             0u - length, 0xfffffff0,    1u << 31, 1024};
  std::uint32_t offset = offsets[input.below(8)];
  if ((flags & 16) != 0) offset += input.number<std::int8_t>();
  return "LC03" + big_endian(input.number() & 3, 4) + big_endian(size, 4) + big_endian(offset, 4) +
         big_endian(number, 2) + big_endian(count, 2) + part.substr(0, 65'487);
}

std::string short_from(fuzz::Input& input) {
  return "LC02" + big_endian(0, 4) + std::string(input.text_block());
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  bus::set_log_level(bus::LogLevel::kSilent);
  static Receiver receiver;
  const Sender sender;
  fuzz::Input input(data, size);
  for (int i = 0; i < kMaxDatagrams && !input.is_empty(); ++i) {
    const std::size_t kind = input.below(4);
    sender.send(kind == 0   ? std::string(input.text_block())
                : kind == 1 ? short_from(input)
                            : fragment_from(input));
  }
  receiver.catch_up(sender);
  return 0;
}
