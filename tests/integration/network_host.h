// SPDX-License-Identifier: BSD-3-Clause
// Hosts of a network, for tests of programs on several: network namespaces that cables join. Within
// scripts/isolated, as root there.
#pragma once

#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace halocline::testing {

// A host of its own: a network namespace at the end of a cable, whose other end cable<number> is in this one.
class Host {
 public:
  explicit Host(int number) : keeper_({"/usr/bin/unshare", "-n", "/bin/sleep", "1000"}) {
    const std::string name = std::to_string(number), pid = std::to_string(keeper_.pid());
    const std::string inside = "nsenter -n -t " + pid + " ";
    // The keeper must have its namespace before the cable's end is put into it.
    run("for i in $(seq 1500); do [ \"$(readlink /proc/" + pid +
        "/ns/net)\" != \"$(readlink /proc/self/ns/net)\" ] && "
        "break; sleep 0.02; done");
    run("ip link add cable" + name + " type veth peer name eth0 netns " + pid);
    run("ip link set cable" + name + " up");
    run(inside + "ip addr add 10.99.0." + std::to_string(number + 10) + "/24 dev eth0");
    run(inside + "ip link set lo up");
    run(inside + "ip link set eth0 up");
    run(inside + "ip route add 224.0.0.0/4 dev eth0");
  }
  void lose(int percent) const {
    run("nsenter -n -t " + std::to_string(keeper_.pid()) + " " HALOCLINE_SOURCE_DIR "/scripts/lose " +
        std::to_string(percent) + " eth0");
  }
  // A command as it runs on this host.
  std::vector<std::string> command(const std::vector<std::string>& words) const {
    std::vector<std::string> all{"/usr/bin/nsenter", "-n", "-t", std::to_string(keeper_.pid())};
    all.insert(all.end(), words.begin(), words.end());
    return all;
  }
  // On this host. Throws when it fails.
  static void run(const std::string& command) {
    if (std::system(("PATH=$PATH:/usr/sbin:/sbin; " + command).c_str()) != 0) {
      throw std::runtime_error("failed: " + command);
    }
  }

 private:
  Process keeper_;
};

// Joins this host and its hosts 0, 1, ... by a bridge that floods multicast; of each cable and of the bridge
// some percent of all frames are lost on their way out.
inline std::vector<std::unique_ptr<Host>> hosts_on_a_bridge(int count, int loss_percent) {
  Host::run("ip link add bridge0 type bridge mcast_snooping 0");
  Host::run("ip addr add 10.99.0.1/24 dev bridge0");
  Host::run("ip link set bridge0 up");
  Host::run("ip route replace 224.0.0.0/4 dev bridge0");
  Host::run(HALOCLINE_SOURCE_DIR "/scripts/lose " + std::to_string(loss_percent) + " bridge0");
  std::vector<std::unique_ptr<Host>> hosts;
  for (int i = 0; i < count; ++i) {
    hosts.push_back(std::make_unique<Host>(i));
    Host::run("ip link set cable" + std::to_string(i) + " master bridge0");
    hosts.back()->lose(loss_percent);
  }
  return hosts;
}

}  // namespace halocline::testing
