// SPDX-License-Identifier: BSD-3-Clause
// A network between hosts that is slow, uneven and loses: joins Ethernet devices of this network namespace as
// a switch would that floods every frame to all others, each copy after a delay of its own.
//
//   slow_switch SEED DELAY_MS JITTER_MS LOSS DEVICE DEVICE...
//
// A copy is lost with the probability LOSS; else it leaves DELAY_MS + u JITTER_MS after it came, u uniform in
// [-1, 1): a later frame with a smaller delay overtakes. Draws come from one generator with the given seed,
// in the order in which frames come. For kernels without netem; refuses the machine's own network namespace.
// Writes what it counted at SIGTERM.
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <queue>
#include <random>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include <arpa/inet.h>
#include <linux/if_packet.h>
#include <net/ethernet.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

namespace {

using Clock = std::chrono::steady_clock;

// The flag in the first byte of a frame's head (virtio_net_hdr of linux/virtio_net.h, which is no C++) that
// may be sent.
constexpr char kNeedsCheckSum = 1;

volatile std::sig_atomic_t stop = 0;

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(what + ": " + std::strerror(errno));
}

std::string namespace_of(const char* process) {
  char name[64] = {};
  const std::string link = std::string("/proc/") + process + "/ns/net";
  return readlink(link.c_str(), name, sizeof name - 1) < 0 ? "" : name;
}

// A raw socket that receives and sends on one device alone.
int open_device(const std::string& name) {
  const int device = socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC, htons(ETH_P_ALL));
  if (device < 0) fail("no raw socket");
  sockaddr_ll address{};
  address.sll_family = AF_PACKET;
  address.sll_protocol = htons(ETH_P_ALL);
  address.sll_ifindex = static_cast<int>(if_nametoindex(name.c_str()));
  if (address.sll_ifindex == 0 || bind(device, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0)
    fail("device " + name);
  const int buffer = 8 << 20;
  if (setsockopt(device, SOL_SOCKET, SO_RCVBUFFORCE, &buffer, sizeof buffer) != 0)
    setsockopt(device, SOL_SOCKET, SO_RCVBUF, &buffer, sizeof buffer);
  packet_mreq all{};
  all.mr_ifindex = address.sll_ifindex;
  all.mr_type = PACKET_MR_PROMISC;
  if (setsockopt(device, SOL_PACKET, PACKET_ADD_MEMBERSHIP, &all, sizeof all) != 0)
    fail("promiscuous " + name);
  // Virtual cables leave check sums and cutting up to a card that is not there: what is to be done goes
  // along.
  const int with_head = 1;
  if (setsockopt(device, SOL_PACKET, PACKET_VNET_HDR, &with_head, sizeof with_head) != 0)
    fail("head " + name);
  return device;
}

struct Waiting {
  Clock::time_point due;
  std::size_t number = 0;  // of frames that leave at one instant the first goes first
  int device = -1;
  std::vector<char> frame;
  bool operator<(const Waiting& other) const {  // the earliest is the greatest
    return std::tie(due, number) > std::tie(other.due, other.number);
  }
};

class Switch {
 public:
  Switch(unsigned seed, double delay_ms, double jitter_ms, double loss,
         const std::vector<std::string>& devices)
      : delay_ms_(delay_ms), jitter_ms_(jitter_ms), loss_(loss), random_(seed) {
    for (const std::string& device : devices) ports_.push_back({open_device(device), POLLIN, 0});
  }
  ~Switch() {
    for (const pollfd& port : ports_) close(port.fd);
    std::printf("copies=%zu lost=%zu overtook=%zu\n", copies_, lost_, overtook_);
  }
  void run() {
    while (stop == 0) {
      send_due();
      const auto left = waiting_.empty()
                            ? std::chrono::nanoseconds(100'000'000)
                            : std::max(waiting_.top().due - Clock::now(), std::chrono::nanoseconds(0));
      const timespec timeout{0, static_cast<long>(std::min<std::int64_t>(left.count(), 100'000'000))};
      if (ppoll(ports_.data(), ports_.size(), &timeout, nullptr) <= 0) continue;
      for (std::size_t i = 0; i < ports_.size(); ++i) {
        if ((ports_[i].revents & POLLIN) != 0) take_all(i);
      }
    }
  }

 private:
  void take_all(std::size_t from) {
    sockaddr_ll sender{};
    for (;;) {
      socklen_t size = sizeof sender;
      const ssize_t length = recvfrom(ports_[from].fd, buffer_, sizeof buffer_, MSG_DONTWAIT,
                                      reinterpret_cast<sockaddr*>(&sender), &size);
      if (length <= 0) return;
      if (sender.sll_pkttype == PACKET_OUTGOING) continue;  // what we sent ourselves
      buffer_[0] &= kNeedsCheckSum;
      for (std::size_t to = 0; to < ports_.size(); ++to) {
        if (to != from) delay(ports_[to].fd, static_cast<std::size_t>(length));
      }
    }
  }
  void delay(int device, std::size_t length) {
    ++copies_;
    const double lost = uniform_(random_), u = 2 * uniform_(random_) - 1;
    if (lost < loss_) {
      ++lost_;
      return;
    }
    const auto delay = std::chrono::duration<double, std::milli>(std::max(0.0, delay_ms_ + u * jitter_ms_));
    const auto due = Clock::now() + std::chrono::duration_cast<Clock::duration>(delay);
    if (due < latest_due_) ++overtook_;
    latest_due_ = std::max(latest_due_, due);
    waiting_.push({due, number_++, device, {buffer_, buffer_ + length}});
  }
  void send_due() {
    for (; !waiting_.empty() && waiting_.top().due <= Clock::now(); waiting_.pop()) {
      const Waiting& next = waiting_.top();
      if (send(next.device, next.frame.data(), next.frame.size(), 0) < 0) ++lost_;
    }
  }

  double delay_ms_, jitter_ms_, loss_;
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> uniform_{0, 1};
  std::vector<pollfd> ports_;
  std::priority_queue<Waiting> waiting_;
  Clock::time_point latest_due_;
  std::size_t number_ = 0, copies_ = 0, lost_ = 0, overtook_ = 0;
  char buffer_[70'000];  // a frame that no card has cut up, and its head
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 7) {
    std::fprintf(stderr, "slow_switch SEED DELAY_MS JITTER_MS LOSS DEVICE DEVICE...\n");
    return 2;
  }
  if (namespace_of("self") == namespace_of("1")) {
    std::fprintf(stderr, "slow_switch: this is the machine's own network; run it inside scripts/isolated\n");
    return 2;
  }
  std::signal(SIGTERM, [](int) { stop = 1; });
  try {
    Switch(static_cast<unsigned>(std::atoi(argv[1])), std::atof(argv[2]), std::atof(argv[3]),
           std::atof(argv[4]), {argv + 5, argv + argc})
        .run();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "slow_switch: %s\n", error.what());
    return 1;
  }
}
