// The filter on sockets of a private loopback network (scripts/isolated).
#include "bus/runtime/receive_filter.h"

#include <cstdint>
#include <fstream>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "bus/bus.h"
#include "bus/transport.h"
#include "tests/bus/messages_for_tests.h"

namespace halocline::bus {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class Socket {
 public:
  Socket() {
    sockaddr_in any{AF_INET, 0, {htonl(INADDR_LOOPBACK)}, {}};
    EXPECT_EQ(bind(socket_, reinterpret_cast<sockaddr*>(&any), sizeof any), 0);
  }
  ~Socket() { close(socket_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  void attach(std::vector<sock_filter> program) {
    const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
    ASSERT_EQ(setsockopt(socket_, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter), 0);
  }
  // Whether what is sent to it arrives; on loopback it is there at once.
  bool receives(const std::string& datagram) {
    sockaddr_in own{};
    socklen_t size = sizeof own;
    getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &size);
    sendto(socket_, datagram.data(), datagram.size(), 0, reinterpret_cast<sockaddr*>(&own), size);
    char buffer[1000];
    return recv(socket_, buffer, sizeof buffer, MSG_DONTWAIT) >= 0;
  }

 private:
  int socket_ = socket(AF_INET, SOCK_DGRAM, 0);
};

std::string short_message(const std::string& channel, const std::string& message = "12345678") {
  return std::string("LC02") + std::string(4, 1) + channel + std::string(1, 0) + message;
}

TEST(ReceiveFilter, PassesWhatAnExpressionMatches) {
  Socket socket;
  socket.attach(receive_program({"STATE\\..*", "CLOCK", "RAY_REPLY\\.channel-a1"}));
  for (const char* channel :
       {"STATE.auv-1", "STATE.", "CLOCK", "RAY_REPLY.channel-a1", "REPAIR.STATE.auv-1", "REPAIR.CLOCK"})
    EXPECT_TRUE(socket.receives(short_message(channel))) << channel;
  for (const char* channel :
       {"COMMAND.auv-1", "STATEX", "STATUS.a", "CLOCKS", "CLOC", "RAY_REPLY.channel-a",
        "RAY_REPLY.channel-a12", "REPAIR_REQUEST", "REPAIR.COMMAND.auv-1", "", "XSTATE.auv-1"})
    EXPECT_FALSE(socket.receives(short_message(channel))) << channel;
}

TEST(ReceiveFilter, ADatagramShorterThanAChannelIsComparedWithTheOthers) {
  Socket socket;
  socket.attach(receive_program({"ABCDEFGHIJKLMNOPQRSTUVWXYZ", "ABC"}));
  EXPECT_TRUE(socket.receives(short_message("ABC", "")));
  EXPECT_FALSE(socket.receives(short_message("ABCD", "")));
}

TEST(ReceiveFilter, WhatIsNoShortMessagePasses) {
  Socket socket;
  socket.attach(receive_program({"CLOCK"}));
  EXPECT_TRUE(socket.receives("LC03" + std::string(20, 2)));
  EXPECT_FALSE(socket.receives("LC"));  // nothing that LCM could read
}

TEST(ReceiveFilter, OfAnExpressionThatIsNoTextEverythingHasToPass) {
  EXPECT_THAT(receive_program({"CLOCK", "STATE.[0-9]+"}), IsEmpty());
  std::multiset<std::string> many;
  for (int i = 0; i < 2000; ++i) many.insert("COMMAND\\.auv-" + std::to_string(i));
  EXPECT_THAT(receive_program(many), IsEmpty());
}

// Datagrams that the kernel did not give to the sockets of a port (proc(5), /proc/net/udp: the last column).
std::int64_t left_out(int port) {
  std::ostringstream place;
  place << std::uppercase << std::hex << ":" << port;
  std::ifstream sockets("/proc/net/udp");
  std::int64_t sum = 0;
  for (std::string line; std::getline(sockets, line);) {
    std::istringstream words(line);
    std::string number, local, word;
    words >> number >> local;
    while (words >> word) {
    }
    if (local.ends_with(place.str())) sum += std::stoll(word);
  }
  return sum;
}

class ReceiveFilterOfLcmTest : public ::testing::Test {
 protected:
  void publish(const std::string& channel, std::int64_t sequence) {
    sim_clock_t message = testing::valid_message<sim_clock_t>(1);
    message.sequence = sequence;
    sender_.publish(channel, message);
    while (lcm_->handleTimeout(50) > 0) {
    }
  }
  void subscribe(Bus& bus, const std::string& channel) {
    bus.subscribe<sim_clock_t>(channel, [this](const sim_clock_t& m) { received_.push_back(m.sequence); });
  }

  static constexpr int kPort = 7701;
  const std::string url_ = "udpm://239.255.76.67:" + std::to_string(kPort) + "?ttl=0";
  const std::unique_ptr<lcm::LCM> lcm_ = open_transport(url_),
                                  other_ = open_transport(url_ + "&recv_buf_size=4096");
  Bus sender_{*other_, {"sender", 1}};
  std::vector<std::int64_t> received_;
};

TEST_F(ReceiveFilterOfLcmTest, FollowsSubscriptions) {
  ReceiveFilter filter(*lcm_, url_);
  Bus bus(*lcm_, {"receiver", 2});
  subscribe(bus, "A");
  filter.follow(&bus.receives(), nullptr);
  publish("A", 1);
  publish("B", 2);
  EXPECT_THAT(received_, ElementsAre(1));
  EXPECT_EQ(left_out(kPort), 1);
  {
    Bus second(*lcm_, {"second", 3});
    subscribe(second, "B");
    filter.follow(&bus.receives(), &second.receives());
    publish("B", 3);
    EXPECT_THAT(received_, ElementsAre(1, 3));
  }
  filter.follow(&bus.receives(), nullptr);
  publish("B", 4);
  publish("A", 5);
  EXPECT_THAT(received_, ElementsAre(1, 3, 5));
  EXPECT_EQ(left_out(kPort), 2);
}

TEST_F(ReceiveFilterOfLcmTest, WithSeveralSocketsOnThePortEverythingPasses) {
  Bus bus(*lcm_, {"receiver", 2});
  subscribe(bus, "A");
  subscribe(sender_, "A");
  ReceiveFilter filter(*lcm_, url_);
  filter.follow(&bus.receives(), nullptr);
  publish("B", 1);
  EXPECT_EQ(left_out(kPort), 0);
}

}  // namespace
}  // namespace halocline::bus
