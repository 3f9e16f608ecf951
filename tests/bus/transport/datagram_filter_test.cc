// SPDX-License-Identifier: BSD-3-Clause
// The filter in the kernel, and LCM behind it, on a private loopback network (scripts/isolated).
#include "bus/transport/datagram_filter.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include "bus/transport/receive_filter.h"
#include "bus/transport/transport.h"
#include "tests/bus/filtered_socket.h"

namespace halocline::bus {
namespace {

using testing::FilteredSocket;
using testing::Fragment;
using testing::short_message;

constexpr std::uint32_t kPartBytes = 65'487;  // of a full fragment
const std::string kChannel("CLOCK\0", 6);

class DatagramFilter : public ::testing::Test {
 protected:
  bool passes(const Fragment& fragment) const { return socket_.receives(fragment.datagram()); }
  bool lets_in(const std::string& datagram) const { return socket_.receives(datagram); }

  const FilteredSocket socket_{datagram_program()};
};

// What LCM 1.3.1 sends for a message of `size` bytes.
std::vector<Fragment> fragments_of(std::uint32_t size, const std::string& channel) {
  const std::string all = channel + std::string(1, 0) + std::string(size, 'x');
  const auto count = static_cast<std::uint32_t>((all.size() + kPartBytes - 1) / kPartBytes);
  std::vector<Fragment> fragments;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::size_t at = std::size_t{i} * kPartBytes;
    const std::size_t offset = i == 0 ? 0 : at - channel.size() - 1;
    fragments.push_back({size, static_cast<std::uint32_t>(offset), i, count, all.substr(at, kPartBytes)});
  }
  return fragments;
}

TEST_F(DatagramFilter, EveryFragmentThatLcmSendsPasses) {
  for (const std::uint32_t size : {65'494u, 65'500u, 131'000u, 1'000'000u, kMaxMessageBytes}) {
    for (const std::string& channel : {std::string(1, 'A'), std::string(63, 'A')}) {
      for (const Fragment& fragment : fragments_of(size, channel))
        EXPECT_TRUE(passes(fragment)) << size << " " << fragment.number;
    }
  }
}

TEST_F(DatagramFilter, SmallerFragmentsThanLcmSendsPass) {
  for (std::uint32_t number = 1; number < 71; ++number)
    EXPECT_TRUE(passes({.size = 100'000,
                        .offset = 1'423 * number - 6,
                        .number = number,
                        .count = 71,
                        .part = std::string(std::min(1'423u, 100'000u - 1'423 * number + 6), 'x')}));
}

TEST_F(DatagramFilter, APayloadBeyondTheSizeIsDropped) {
  EXPECT_FALSE(
      passes({.size = 1024, .offset = 0xfffffff0, .number = 1, .count = 3, .part = std::string(32, 'A')}));
  EXPECT_FALSE(passes({.size = 1024, .offset = 1025, .number = 1, .count = 3, .part = ""}));
  EXPECT_FALSE(passes({.size = 1024, .offset = 1000, .number = 1, .count = 3, .part = std::string(25, 'A')}));
  EXPECT_TRUE(passes({.size = 1024, .offset = 1000, .number = 1, .count = 3, .part = std::string(24, 'A')}));
  EXPECT_FALSE(passes({.size = 3, .number = 0, .count = 3, .part = kChannel + "1234"}));
  EXPECT_TRUE(passes({.size = 3, .number = 0, .count = 3, .part = kChannel + "123"}));
}

TEST_F(DatagramFilter, AHeaderCutShortIsDropped) {
  const std::string whole = Fragment{.size = 8, .offset = 8, .number = 1, .count = 3, .part = ""}.datagram();
  ASSERT_EQ(whole.size(), 20u);
  EXPECT_TRUE(lets_in(whole));
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(lets_in(whole.substr(0, size))) << size;
}

TEST_F(DatagramFilter, SizesBeyondTheLargestMessageOrWhatTheFragmentsHoldAreDropped) {
  const auto with = [&](std::uint32_t size, std::uint32_t count) {
    return passes({.size = size, .count = count});
  };
  EXPECT_TRUE(with(kMaxMessageBytes, 60'000));
  for (const std::uint32_t size : {kMaxMessageBytes + 1, 1u << 28, 1u << 31, 0xffffffffu, 0u})
    EXPECT_FALSE(with(size, 60'000)) << size;
  EXPECT_TRUE(with(2 * kPartBytes - 1, 2));
  EXPECT_FALSE(with(2 * kPartBytes, 2));
  EXPECT_FALSE(passes({.size = 0, .number = 1, .count = 2, .part = ""}));
}

TEST_F(DatagramFilter, NumbersFromTheCountOnAreDropped) {
  for (const auto& [number, count] :
       {std::pair{0u, 0u}, {1u, 1u}, {2u, 2u}, {65'535u, 2u}, {65'535u, 65'535u}})
    EXPECT_FALSE(passes({.offset = 10, .number = number, .count = count, .part = "x"}))
        << number << " " << count;
  EXPECT_TRUE(passes({.offset = 10, .number = 65'533, .count = 65'535, .part = "x"}));
}

// Else a message of 16 MB with old memory in it would cost its sender one datagram.
TEST_F(DatagramFilter, TheLastFragmentReachesTheEnd) {
  EXPECT_FALSE(passes({.size = 1000, .number = 0, .count = 1, .part = kChannel + "x"}));
  EXPECT_TRUE(passes({.size = 1, .number = 0, .count = 1, .part = kChannel + "x"}));
  EXPECT_FALSE(passes({.size = 1000, .offset = 500, .number = 1, .count = 2, .part = std::string(499, 'x')}));
  EXPECT_TRUE(passes({.size = 1000, .offset = 500, .number = 1, .count = 2, .part = std::string(500, 'x')}));
}

TEST_F(DatagramFilter, TheFirstFragmentBeginsWithAWholeChannelAtOffset0) {
  EXPECT_TRUE(passes({.part = std::string(63, 'A') + std::string(1, 0)}));
  EXPECT_FALSE(passes({.part = std::string(64, 'A') + std::string(1, 0)}));
  EXPECT_FALSE(passes({.part = std::string(63, 'A')}));
  EXPECT_FALSE(passes({.part = std::string(5'000, 'A')}));
  EXPECT_FALSE(passes({.part = ""}));
  EXPECT_FALSE(passes({.offset = 1}));
}

TEST_F(DatagramFilter, AShortMessageHasAWholeChannel) {
  EXPECT_TRUE(lets_in(short_message(std::string(63, 'A'), "")));
  EXPECT_TRUE(lets_in(short_message("", "")));
  EXPECT_FALSE(lets_in(short_message(std::string(64, 'A'))));
  EXPECT_FALSE(lets_in("LC02" + std::string(4, 1)));
  EXPECT_FALSE(lets_in("LC02" + std::string(4, 1) + "CLOCK"));
}

TEST_F(DatagramFilter, WhatIsNoDatagramOfLcmIsDropped) {
  for (const char* word : {"LC01", "LC04", "lc02", "\0\0\0\0"})
    EXPECT_FALSE(lets_in(std::string(word, 4) + std::string(4, 1) + kChannel + "12345678")) << word;
  EXPECT_FALSE(lets_in(""));
}

std::uint32_t number_in(const std::string& datagram, std::size_t at, std::size_t bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i) value = value << 8 | static_cast<std::uint8_t>(datagram[at + i]);
  return value;
}

// The rules of the header, once more and plainly.
bool is_sound(const std::string& datagram) {
  const auto channel_bytes = [&](std::size_t at) -> std::size_t {  // with its 0; 0 for none
    const std::size_t end = datagram.find('\0', at);
    return end != std::string::npos && end - at <= 63 ? end - at + 1 : 0;
  };
  if (datagram.starts_with("LC02")) return datagram.size() > 8 && channel_bytes(8) > 0;
  if (!datagram.starts_with("LC03") || datagram.size() < 20) return false;
  const std::uint64_t size = number_in(datagram, 8, 4), offset = number_in(datagram, 12, 4),
                      number = number_in(datagram, 16, 2), count = number_in(datagram, 18, 2);
  std::uint64_t payload = datagram.size() - 20;
  if (size == 0 || size > kMaxMessageBytes || size >= count * kPartBytes || number >= count || offset > size)
    return false;
  if (number == 0) {
    if (offset != 0 || channel_bytes(20) == 0) return false;
    payload -= channel_bytes(20);
  }
  return number + 1 == count ? offset + payload == size : offset + payload <= size;
}

// Numbers near every limit, and one byte in two hundred anything.
std::string drawn_datagram(std::mt19937& random) {
  const auto below = [&](std::uint32_t count) { return static_cast<std::uint32_t>(random() % count); };
  const std::string channel(below(70), 'C'), data(below(90), "x\0"[below(2)]);
  if (below(4) == 0)
    return "LC02" + std::string(4, 1) + channel + (below(4) == 0 ? "" : std::string(1, 0)) + data;
  Fragment one{.number = below(3), .count = below(4), .part = data};
  if (one.number == 0) one.part = channel + (below(8) == 0 ? "" : std::string(1, 0)) + data;
  const auto length = static_cast<std::uint32_t>(data.size());
  const std::uint32_t sizes[] = {length, length + 1, length - 1, kMaxMessageBytes, kMaxMessageBytes + 1,
                                 0,      2 * length};
  one.size = sizes[below(7)];
  const std::uint32_t offsets[] = {0,           1,      one.size, one.size - length, one.size - length + 1,
                                   0u - length, 0u - 16};
  one.offset = offsets[below(one.number == 0 ? 2 : 7)];
  std::string datagram = one.datagram();
  for (char& byte : datagram) {
    if (below(200) == 0) byte = static_cast<char>(random());
  }
  return below(16) == 0 ? datagram.substr(0, below(40)) : datagram;
}

TEST_F(DatagramFilter, DecidesAsItsRulesOnAnyDatagram) {
  std::mt19937 random(1);
  int sound = 0;
  for (int i = 0; i < 40'000; ++i) {
    const std::string datagram = drawn_datagram(random);
    ASSERT_EQ(lets_in(datagram), is_sound(datagram)) << i << ": " << ::testing::PrintToString(datagram);
    sound += is_sound(datagram) ? 1 : 0;
  }
  EXPECT_GT(sound, 4'000);
}

// Somebody on the bus of an LCM with the filter that it has from the start.
class BehindTheFilter : public ::testing::Test {
 protected:
  BehindTheFilter() {
    receiver_->subscribe(".*", &BehindTheFilter::on_message, this);
    const int ttl = 0;
    setsockopt(sender_, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
  }
  ~BehindTheFilter() override { close(sender_); }
  void send(const std::string& datagram) const {
    const sockaddr_in group{AF_INET, htons(kPort), {htonl(0xefff4c43)}, {}};
    EXPECT_GT(sendto(sender_, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&group),
                     sizeof group),
              0);
  }
  std::vector<std::size_t> sizes_received() {
    while (receiver_->handleTimeout(200) > 0) {
    }
    return sizes_;
  }

 private:
  void on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    if (channel != "LCM_SELF_TEST") sizes_.push_back(buffer->data_size);
  }

  static constexpr int kPort = 7702;
  const std::unique_ptr<lcm::LCM> receiver_ =
      open_transport("udpm://239.255.76.67:7702?ttl=0&recv_buf_size=4194304");
  const int sender_ = socket(AF_INET, SOCK_DGRAM, 0);
  std::vector<std::size_t> sizes_;
};

TEST_F(BehindTheFilter, TwoFragmentsThatWouldWriteFourGigabytesAwayDoNothing) {
  send(Fragment{.size = 1024, .count = 3}.datagram());
  send(Fragment{.size = 1024, .offset = 0xfffffff0, .number = 1, .count = 3, .part = std::string(32, 'A')}
           .datagram());
  send(Fragment{.size = 1024, .count = 3, .part = "CLOCK"}.datagram());
  send(Fragment{.size = 8, .count = 1, .part = kChannel + "12345678"}.datagram());
  EXPECT_EQ(sizes_received(), std::vector<std::size_t>{8});
}

// The buffer that LCM reads into holds an earlier datagram, in which a channel that ends early goes on.
TEST_F(BehindTheFilter, AShortMessageThatEndsWithinItsChannelDoesNothing) {
  send(short_message("CLOCK", ""));
  for (const char* cut : {"C", "CLOC", "CLOCK", ""}) send("LC02" + std::string(4, 1) + cut);
  EXPECT_EQ(sizes_received(), std::vector<std::size_t>{0});
}

TEST_F(BehindTheFilter, LargeMessagesArrive) {
  lcm::LCM publisher("udpm://239.255.76.67:7702?ttl=0");
  const std::vector<std::uint8_t> bytes(1'000'000, 7);
  std::vector<std::size_t> sent;
  for (const std::size_t size : {65'493, 65'494, 131'000, 1'000'000}) {
    publisher.publish("CLOCK", bytes.data(), static_cast<unsigned>(size));
    sent.push_back(size);
  }
  EXPECT_EQ(sizes_received(), sent);
}

// Nothing but LCM's own call to bind() has attached it.
TEST(LcmAtItsStart, ReadsBehindTheFilter) {
  const std::string url = "udpm://239.255.76.67:7704?ttl=0";
  const auto lcm = open_transport(url);
  socklen_t instructions = 0;  // asked for alone
  EXPECT_EQ(getsockopt(receive_socket(*lcm, url), SOL_SOCKET, SO_GET_FILTER, nullptr, &instructions), 0);
  EXPECT_EQ(instructions, datagram_program().size());
}

}  // namespace
}  // namespace halocline::bus
