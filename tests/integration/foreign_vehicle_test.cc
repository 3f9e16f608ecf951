// Two vehicles that know nothing of Halocline, the services as separate processes, all on a private bus.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace {

// A network namespace of its own, with multicast on loopback.
constexpr const char* kPrivateBus =
    "ip link set lo up && ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo || exit 77\n";
constexpr int kNoNamespace = 77;

std::string output_of(const std::string& script, int& exit_code) {
  const std::string path = ::testing::TempDir() + "foreign-vehicle-" + std::to_string(getpid()) + ".sh";
  std::ofstream(path) << script;
  std::FILE* pipe = popen(("unshare -rn bash " + path + " 2>&1").c_str(), "r");
  std::string text;
  for (char part[256]; std::fgets(part, sizeof part, pipe) != nullptr;) text += part;
  exit_code = WEXITSTATUS(pclose(pipe));
  std::remove(path.c_str());
  return text;
}

// The first packet of the visitor is sent 2 s into its life; start-up and a busy machine get the rest.
TEST(ForeignVehicle, IsHeardByAnotherThroughTheWater) {
  if (std::system("unshare -rn true 2>/dev/null") != 0) GTEST_SKIP() << "no network namespaces here";
  const std::string scenario = std::string(HALOCLINE_SOURCE_DIR) + "/scenarios/independent.toml";
  const std::string quiet = scenario + " --log-level error & ";
  const std::string script =
      std::string(kPrivateBus) + "cd " + HALOCLINE_BIN_DIR + "\n./halocline-conductor " + quiet +
      "./halocline-bathymetry " + quiet + "./halocline-channel-server " + quiet +
      "\n./foreign-vehicle --name visitor --id 77 --depth 60 --every 2 >/dev/null &\n"
      "timeout 12 ./foreign-vehicle --name neighbour --id 78 --depth 80 --north 400 --every 0\n"
      "kill $(jobs -p)\nwait\nexit 0\n";
  int exit_code = 0;
  const std::string heard = output_of(script, exit_code);
  if (exit_code == kNoNamespace) GTEST_SKIP() << "no multicast on loopback here";
  EXPECT_THAT(heard, ::testing::HasSubstr("from vehicle 77"));
  EXPECT_THAT(heard, ::testing::HasSubstr("hello 0 from visitor"));
}

}  // namespace
