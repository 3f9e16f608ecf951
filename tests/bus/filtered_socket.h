// SPDX-License-Identifier: BSD-3-Clause
// A socket with a packet filter, and datagrams as LCM and others send them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <linux/filter.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace halocline::bus::testing {

class FilteredSocket {
 public:
  explicit FilteredSocket(std::vector<sock_filter> program) {
    sockaddr_in any{AF_INET, 0, {htonl(INADDR_LOOPBACK)}, {}};
    EXPECT_EQ(bind(socket_, reinterpret_cast<sockaddr*>(&any), sizeof any), 0);
    const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
    EXPECT_EQ(setsockopt(socket_, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter), 0);
  }
  ~FilteredSocket() { close(socket_); }
  FilteredSocket(const FilteredSocket&) = delete;
  FilteredSocket& operator=(const FilteredSocket&) = delete;

  // Whether what is sent to it arrives; on loopback it is there at once.
  bool receives(const std::string& datagram) const {
    sockaddr_in own{};
    socklen_t size = sizeof own;
    getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &size);
    EXPECT_EQ(sendto(socket_, datagram.data(), datagram.size(), 0, reinterpret_cast<sockaddr*>(&own), size),
              static_cast<ssize_t>(datagram.size()));
    char first_byte = 0;
    return recv(socket_, &first_byte, 1, MSG_DONTWAIT) >= 0;
  }

 private:
  int socket_ = socket(AF_INET, SOCK_DGRAM, 0);
};

inline std::string big_endian(std::uint32_t value, int bytes) {
  std::string text;
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) text += static_cast<char>(value >> shift);
  return text;
}

inline std::string short_message(const std::string& channel, const std::string& message = "12345678") {
  return std::string("LC02") + std::string(4, 1) + channel + std::string(1, 0) + message;
}

// A datagram of LCM's fragmented form. `part` of number 0 begins with the channel and its 0.
struct Fragment {
  std::uint32_t size = 100'000, offset = 0;
  std::uint32_t number = 0, count = 2;  // 16 bits of each are sent
  std::string part = std::string("CLOCK\0", 6) + std::string(400, 'x');

  std::string datagram() const {
    return "LC03" + big_endian(7, 4) + big_endian(size, 4) + big_endian(offset, 4) + big_endian(number, 2) +
           big_endian(count, 2) + part;
  }
};

}  // namespace halocline::bus::testing
