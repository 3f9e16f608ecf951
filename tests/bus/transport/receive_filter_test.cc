// SPDX-License-Identifier: BSD-3-Clause
// The filter on sockets of a private loopback network (scripts/isolated).
#include "bus/transport/receive_filter.h"

#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <map>
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
#include "bus/transport/transport.h"
#include "core/check.h"
#include "tests/bus/filtered_socket.h"
#include "tests/bus/messages_for_tests.h"
#include "tests/support/process.h"

namespace halocline::bus {
namespace {

using ::testing::ElementsAre;
using testing::FilteredSocket;
using testing::Fragment;
using testing::short_message;

TEST(ReceiveFilter, PassesWhatAnExpressionMatches) {
  const FilteredSocket socket(receive_program({"STATE\\..*", "CLOCK", "RAY_REPLY\\.channel-a1"}));
  for (const char* channel :
       {"STATE.auv-1", "STATE.", "CLOCK", "RAY_REPLY.channel-a1", "REPAIR.STATE.auv-1", "REPAIR.CLOCK"})
    EXPECT_TRUE(socket.receives(short_message(channel))) << channel;
  for (const char* channel :
       {"COMMAND.auv-1", "STATEX", "STATUS.a", "CLOCKS", "CLOC", "RAY_REPLY.channel-a",
        "RAY_REPLY.channel-a12", "REPAIR_REQUEST", "REPAIR.COMMAND.auv-1", "", "XSTATE.auv-1"})
    EXPECT_FALSE(socket.receives(short_message(channel))) << channel;
}

TEST(ReceiveFilter, ThisHostIsAlwaysAccepted) {
  const FilteredSocket socket(receive_program({"CLOCK"}, accepted_hosts("", "")));
  EXPECT_TRUE(socket.receives(short_message("CLOCK")));
  EXPECT_FALSE(socket.receives(short_message("STATE.a")));
}

TEST(ReceiveFilter, ADatagramShorterThanAChannelIsComparedWithTheOthers) {
  const FilteredSocket socket(receive_program({"ABCDEFGHIJKLMNOPQRSTUVWXYZ", "ABC"}));
  EXPECT_TRUE(socket.receives(short_message("ABC", "")));
  EXPECT_FALSE(socket.receives(short_message("ABCD", "")));
}

TEST(ReceiveFilter, AChannelThatBeginsAsAnExpressionEndsWithinTheDatagram) {
  const FilteredSocket socket(receive_program({"STATE\\..*", "CLOCK"}));
  const std::string header = "LC02" + std::string(4, 1);
  for (const char* cut : {"STATE.", "STATE.auv-1", "REPAIR.STATE.auv-1", "CLOCK"})
    EXPECT_FALSE(socket.receives(header + cut)) << cut;
  EXPECT_TRUE(socket.receives(short_message("STATE." + std::string(57, 'a'))));
  EXPECT_FALSE(socket.receives(short_message("STATE." + std::string(58, 'a'))));
}

TEST(ReceiveFilter, SoundFragmentsPassWhateverTheirChannel) {
  const FilteredSocket socket(receive_program({"CLOCK"}));
  EXPECT_TRUE(socket.receives(Fragment{.part = std::string("STATE.a\0xyz", 11)}.datagram()));
  EXPECT_FALSE(socket.receives(Fragment{.offset = 0xfffffff0, .number = 1}.datagram()));
}

// The last one is of too many instructions.
TEST(ReceiveFilter, WhereEveryChannelPassesUnsoundDatagramsDoNot) {
  std::multiset<std::string> many;
  for (int i = 0; i < 2000; ++i) many.insert("COMMAND\\.auv-" + std::to_string(i));
  for (const std::multiset<std::string>& expressions :
       {std::multiset<std::string>{".*"}, {"CLOCK", "STATE.[0-9]+"}, many}) {
    const FilteredSocket socket(receive_program(expressions));
    EXPECT_TRUE(socket.receives(short_message("ANY")));
    EXPECT_TRUE(socket.receives(Fragment().datagram()));
    EXPECT_FALSE(socket.receives(short_message(std::string(64, 'A'))));
    EXPECT_FALSE(socket.receives(Fragment{.offset = 0xfffffff0, .number = 1}.datagram()));
  }
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

TEST(AcceptedHosts, AreReadFromTheScenario) {
  const std::string here = "udpm://239.255.76.67:7667?ttl=0", network = "udpm://239.255.76.67:7667?ttl=1";
  EXPECT_FALSE(accepted_hosts("", here).any);
  EXPECT_FALSE(accepted_hosts("", "udpm://239.255.76.67:7667").any);
  EXPECT_TRUE(accepted_hosts("", network).any);
  EXPECT_TRUE(accepted_hosts("any", here).any);
  const AcceptedHosts two = accepted_hosts("10.0.3.7, 10.0.4.0/24", network);
  ASSERT_EQ(two.ranges.size(), 2u);
  EXPECT_EQ(two.ranges[0].address, 0x0a000307u);
  EXPECT_EQ(two.ranges[0].mask, 0xffffffffu);
  EXPECT_EQ(two.ranges[1].mask, 0xffffff00u);
  EXPECT_EQ(accepted_hosts("0.0.0.0/0", here).ranges[0].mask, 0u);
  for (const char* wrong :
       {"localhost", "10.0.3", "10.0.3.7/33", "10.0.3.7/", "10.0.3.7/x", "10.0.3.7,,10.0.3.8"})
    EXPECT_THROW(accepted_hosts(wrong, here), InvalidArgument) << wrong;
}

// Another host, in a network namespace of its own, with the address 10.9.0.2; this one has 10.9.0.1.
class OtherHost {
 public:
  OtherHost() : process_({"/usr/bin/unshare", "-n", "/bin/sleep", "60"}) {
    const std::string pid = std::to_string(process_.pid());
    enter_ = "nsenter -t " + pid + " -n ";
    // Until the process has its namespace.
    EXPECT_EQ(run("while [ \"$(readlink /proc/" + pid +
                  "/ns/net)\" = \"$(readlink /proc/self/ns/net)\" ]; do sleep 0.01; done"),
              0);
    EXPECT_EQ(run("ip link add va type veth peer name vb netns " + pid +
                  " && ip addr add 10.9.0.1/24 dev va && ip link set va up"),
              0);
    EXPECT_EQ(run(enter_ + "ip addr add 10.9.0.2/24 dev vb && " + enter_ + "ip link set vb up"), 0);
    // The first datagram does not wait for the link, nor for an answer to who has the address.
    EXPECT_EQ(run("until ip link show va | grep -q 'state UP'; do sleep 0.01; done; " + enter_ +
                  "ip neigh replace 10.9.0.1 dev vb lladdr "
                  "$(ip link show va | sed -n 's/.*ether \\([^ ]*\\).*/\\1/p')"),
              0);
  }
  void send(const std::string& datagram, int port) const {
    const std::string file = "/dev/udp/10.9.0.1/" + std::to_string(port);
    EXPECT_EQ(run(enter_ + "bash -c \"printf '" + datagram + "' >" + file + "\""), 0);
  }

 private:
  static int run(const std::string& command) {
    return std::system(("PATH=$PATH:/sbin:/usr/sbin; " + command).c_str());
  }
  halocline::testing::Process process_;
  std::string enter_;
};

TEST(ReceiveFilter, UnicastOfAnotherHostIsReceivedOnlyWhereItIsAccepted) {
  const OtherHost other;
  const auto received_with = [&](const std::string& accept, const std::set<std::string>& expressions) {
    const int receiver = socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in any{AF_INET, 0, {htonl(INADDR_ANY)}, {}};
    EXPECT_EQ(bind(receiver, reinterpret_cast<sockaddr*>(&any), sizeof any), 0);
    socklen_t size = sizeof any;
    getsockname(receiver, reinterpret_cast<sockaddr*>(&any), &size);
    auto program = receive_program({expressions.begin(), expressions.end()}, accepted_hosts(accept, ""));
    const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
    EXPECT_EQ(setsockopt(receiver, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter), 0);
    const timeval longest{0, 300'000};
    setsockopt(receiver, SOL_SOCKET, SO_RCVTIMEO, &longest, sizeof longest);
    other.send("LC02\\001\\001\\001\\001CLOCK\\000x", ntohs(any.sin_port));
    char buffer[1000];
    const bool received = recv(receiver, buffer, sizeof buffer, 0) > 0;
    close(receiver);
    return received;
  };
  EXPECT_TRUE(received_with("any", {"CLOCK"}));
  EXPECT_FALSE(received_with("", {"CLOCK"}));
  EXPECT_FALSE(received_with("", {"[A-Z]*"}));  // where no channel is left out
  EXPECT_FALSE(received_with("10.9.0.3, 10.8.0.0/16", {"CLOCK"}));
  EXPECT_TRUE(received_with("10.9.0.3, 10.9.0.2", {"CLOCK"}));
  EXPECT_TRUE(received_with("10.9.0.0/24", {"CLOCK"}));
  EXPECT_FALSE(received_with("10.9.0.0/24", {"STATE"}));
}

// On their ordinary bus, and on the two ports of lockstep.
TEST(ReceiveFilter, EveryProgramThatListensLeavesOutOtherHosts) {
  using halocline::testing::Process;
  const OtherHost other;
  const std::string scenario = HALOCLINE_TEST_DATA "/scenarios/two_vehicles.toml";
  const auto command = [&](const std::string& program, const std::vector<std::string>& options) {
    std::vector<std::string> words{HALOCLINE_BIN_DIR "/halocline-" + program};
    words.insert(words.end(), options.begin(), options.end());
    return words;
  };
  const std::map<int, std::vector<std::string>> listening{
      {7667, command("monitor", {"--port", "0"})},
      {7677, command("channel-server", {scenario, "--time-source", "lockstep"})},
      {7678, command("conductor", {scenario, "--lockstep", "--expect", "none"})}};
  for (const auto& [port, words] : listening) {
    Process process(words);
    const auto left_out_after = [&, at = port] {
      other.send("LC02\\001\\001\\001\\001LOCKSTEP_GRANT\\000x", at);
      usleep(100'000);
      return left_out(at);
    };
    for (int i = 0; i < 100 && left_out_after() == 0; ++i) EXPECT_TRUE(process.running()) << process.output();
    EXPECT_GT(left_out(port), 0) << words[0];
  }
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

TEST(ReceiveFilter, WhereTheKernelTakesNoneTheProgramWarns) {
  if (std::system("PATH=$PATH:/sbin:/usr/sbin; sysctl -qw net.core.optmem_max=6000") != 0)
    GTEST_SKIP() << "the kernel has one limit for all network namespaces";
  halocline::testing::Process program({HALOCLINE_BIN_DIR "/halocline-conductor"});
  for (int i = 0; i < 200 && program.output().find("started") == std::string::npos; ++i) usleep(100'000);
  EXPECT_THAT(program.output(), ::testing::HasSubstr("receive-filter-missing"));
  program.signal(SIGTERM);
  EXPECT_EQ(program.wait(), 0);
  std::system("PATH=$PATH:/sbin:/usr/sbin; sysctl -qw net.core.optmem_max=131072");
}

// As Linux grants before 6.7; of this network namespace alone.
TEST_F(ReceiveFilterOfLcmTest, FollowsSubscriptionsWithTwentyKilobytesForFilters) {
  if (std::system("PATH=$PATH:/sbin:/usr/sbin; sysctl -qw net.core.optmem_max=20480") != 0)
    GTEST_SKIP() << "the kernel has one limit for all network namespaces";
  ReceiveFilter filter(*lcm_, url_);
  Bus bus(*lcm_, {"receiver", 2});
  for (int i = 0; i < 6; ++i) subscribe(bus, "A" + std::string(20, 'a') + std::to_string(i));
  filter.follow(&bus.receives(), nullptr);
  publish("A" + std::string(20, 'a') + "5", 1);
  publish("B", 2);
  EXPECT_THAT(received_, ElementsAre(1));
  EXPECT_EQ(left_out(kPort), 1);
  for (int i = 0; i < 200; ++i) subscribe(bus, "C" + std::string(20, 'c') + std::to_string(i));
  filter.follow(&bus.receives(), nullptr);  // now too many for the kernel
  publish("C" + std::string(20, 'c') + "199", 3);
  publish("B", 4);
  EXPECT_THAT(received_, ElementsAre(1, 3));
  EXPECT_EQ(left_out(kPort), 1);
  std::system("PATH=$PATH:/sbin:/usr/sbin; sysctl -qw net.core.optmem_max=131072");
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
