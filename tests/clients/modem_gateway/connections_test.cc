// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/connections.h"

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <termios.h>

#include "bus/runtime/node_process.h"
#include "core/check.h"
#include "tests/clients/modem_gateway/host.h"
#include "tests/support/working_folder.h"

namespace halocline::modem_gateway {
namespace {

using testing::Host;
using testing::work_until;
using Change = Connections::Change;

// Answers "<client bytes>" to everything.
class Echo {
 public:
  std::size_t add(const std::string& place) { return connections.add(place_of(place)); }
  void work() {
    for (auto& input : connections.take(bus::steady_now())) {
      if (input.change == Change::kOpened) ++opened;
      if (input.change == Change::kClosed) ++closed;
      if (input.change != Change::kBytes) continue;
      received += input.bytes.size();
      if (!is_silent) connections.write(input.interface, input.client, "<" + input.bytes + ">");
    }
  }
  // What `host` gets until that is `size` bytes.
  std::string read(Host& host, std::size_t size) {
    std::string text;
    work_until([&] { work(), text += host.read(); }, [&] { return text.size() >= size; });
    return text;
  }

  Connections connections;
  int opened = 0, closed = 0;
  std::size_t received = 0;
  bool is_silent = false;
};

TEST(Connections, EachHostHasAConversationOfItsOwn) {
  Echo echo;
  const auto interface = echo.add("tcp:0");
  Host one(echo.connections.place_of(interface)), two(echo.connections.place_of(interface));
  one.write("one");
  two.write("two");
  EXPECT_EQ(echo.read(one, 5), "<one>");
  EXPECT_EQ(echo.read(two, 5), "<two>");
  echo.connections.write(interface, kAllClients, "all");
  EXPECT_EQ(echo.read(one, 3), "all");
  EXPECT_EQ(echo.read(two, 3), "all");
  one.close();
  EXPECT_TRUE(work_until([&] { echo.work(); }, [&] { return echo.closed == 1; }));
  two.write("x");
  EXPECT_EQ(echo.read(two, 3), "<x>");
}

TEST(Connections, ASerialLineIsOpenedUsedClosedAndOpenedAgain) {
  const halocline::testing::TemporaryFolder folder;
  Echo echo;
  const std::string place = "pty:modem";
  echo.add(place);
  for (int times = 1; times <= 2; ++times) {
    {
      Host host(place);
      ASSERT_TRUE(work_until([&] { echo.work(); }, [&] { return echo.opened == times; }));
      host.write(std::string_view("a\r\n\x03\x04\xff", 6));  // nothing is changed, as on a raw line
      EXPECT_EQ(echo.read(host, 8), std::string("<a\r\n\x03\x04\xff>"));
    }
    ASSERT_TRUE(work_until([&] { echo.work(); }, [&] { return echo.closed == times; }));
    echo.connections.write(0, kAllClients, "nobody reads this");
  }
}

TEST(Connections, ASerialLineIsRawWhenAHostOpensIt) {
  const halocline::testing::TemporaryFolder folder;
  Connections connections;
  connections.add(place_of("pty:modem"));
  const FileDescriptor line(open("modem", O_RDWR | O_NOCTTY | O_CLOEXEC));
  termios settings{};
  ASSERT_EQ(tcgetattr(line.get(), &settings), 0);
  EXPECT_EQ(settings.c_lflag & (ICANON | ECHO | ISIG | IEXTEN), 0u);
  EXPECT_EQ(settings.c_iflag & (ICRNL | INLCR | IXON | ISTRIP), 0u);
  EXPECT_EQ(settings.c_oflag & OPOST, 0u);
}

TEST(Connections, TheLinkToASerialLineGoesWithIt) {
  const halocline::testing::TemporaryFolder folder;
  {
    Connections connections;
    connections.add(place_of("pty:modem"));
    EXPECT_TRUE(std::filesystem::is_symlink("modem"));
    EXPECT_THROW(connections.add(place_of("pty:/nowhere/at/all")), InvalidArgument);
    for (int i = 0; i < 10; ++i)
      connections.add(place_of("pty:other" + std::to_string(i)));  // which move the first
    EXPECT_TRUE(std::filesystem::is_symlink("modem"));
  }
  EXPECT_TRUE(std::filesystem::is_empty("."));
}

TEST(Connections, ALinkThatAnotherHasMadeSinceStays) {
  const halocline::testing::TemporaryFolder folder;
  {
    auto first = std::make_unique<Connections>();
    first->add(place_of("pty:modem"));
    Connections second;
    second.add(place_of("pty:modem"));  // replaces it
    first.reset();
    EXPECT_TRUE(std::filesystem::exists("modem"));
    std::filesystem::remove("modem");
    std::filesystem::create_symlink("elsewhere", "modem");
  }
  EXPECT_EQ(std::filesystem::read_symlink("modem"), "elsewhere");
}

TEST(Connections, OnlyASymbolicLinkIsReplaced) {
  const halocline::testing::TemporaryFolder folder;
  std::ofstream("file") << "mine";
  std::filesystem::create_directory("folder");
  std::filesystem::create_symlink("gone", "dangling");
  Connections connections;
  for (const auto* place : {"pty:file", "pty:folder"})
    EXPECT_THROW(connections.add(place_of(place)), InvalidArgument) << place;
  connections.add(place_of("pty:dangling"));
  EXPECT_TRUE(std::filesystem::is_regular_file("file"));
  EXPECT_TRUE(std::filesystem::is_directory("folder"));
  EXPECT_TRUE(std::filesystem::is_character_file("dangling"));
}

TEST(Connections, AHostThatIsDisconnectedIsReportedAsClosed) {
  Echo echo;
  const auto interface = echo.add("tcp:0");
  Host host(echo.connections.place_of(interface));
  ASSERT_TRUE(work_until([&] { echo.work(); }, [&] { return echo.opened == 1; }));
  echo.connections.disconnect(1);
  EXPECT_TRUE(
      work_until([&] { echo.work(), host.read(); }, [&] { return echo.closed == 1 && !host.is_open(); }));
}

TEST(Connections, AHostThatNeverReadsLosesWholeWritesAndNobodyElseAny) {
  Echo echo;
  const auto interface = echo.add("tcp:0"), other = echo.add("tcp:0");
  const Host deaf(echo.connections.place_of(interface));
  Host host(echo.connections.place_of(other));
  ASSERT_TRUE(work_until([&] { echo.work(); }, [&] { return echo.opened == 2; }));
  for (int i = 0; i < 20'000 && echo.connections.counters().writes_dropped == 0; ++i)
    echo.connections.write(interface, kAllClients, std::string(1024, 'x'));
  EXPECT_GT(echo.connections.counters().writes_dropped, 0);
  host.write("still here");
  EXPECT_EQ(echo.read(host, 12), "<still here>");
}

TEST(Connections, TurnsAwayMoreHostsThanItHolds) {
  Echo echo;
  const auto interface = echo.add("tcp:0");
  std::vector<std::unique_ptr<Host>> hosts;
  for (std::size_t i = 0; i < 500; ++i) {
    hosts.push_back(std::make_unique<Host>(echo.connections.place_of(interface)));
    echo.work();
  }
  ASSERT_TRUE(
      work_until([&] { echo.work(); }, [&] { return echo.connections.counters().turned_away == 500 - 32; }));
  EXPECT_EQ(echo.connections.clients(), Connections::kMaxClients);
  hosts[0]->write("first");
  EXPECT_EQ(echo.read(*hosts[0], 7), "<first>");
  hosts.clear();
  EXPECT_TRUE(work_until([&] { echo.work(); }, [&] { return echo.connections.clients() == 0; }));
}

TEST(Connections, AFloodOfOneHostComesInPieces) {
  Echo echo;
  echo.is_silent = true;
  const auto interface = echo.add("tcp:0");
  const Host host(echo.connections.place_of(interface));
  for (int i = 0; i < 64; ++i) {
    host.write(std::string(16 * 1024, 'x'));
    for (const auto& input : echo.connections.take(bus::steady_now()))
      EXPECT_LE(input.bytes.size(), Connections::kMaxPiece);
  }
}

TEST(Connections, APlaceThatIsTakenIsRefused) {
  Connections connections;
  const auto interface = connections.add(place_of("tcp:0"));
  EXPECT_THROW(connections.add(place_of(connections.place_of(interface))), InvalidArgument);
  EXPECT_THROW(connections.add(place_of("pty:/nowhere/at/all")), InvalidArgument);
}

}  // namespace
}  // namespace halocline::modem_gateway
