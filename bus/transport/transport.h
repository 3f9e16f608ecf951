// SPDX-License-Identifier: BSD-3-Clause
// Opens an lcm::LCM with the settings that Halocline needs; error messages name the fault in a URL.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include <lcm/lcm-cpp.hpp>

namespace halocline::bus {

// LCM's usual group, restricted to this host, with a receive buffer that holds a burst (LCM's default loses
// 65 % of 100 messages published back to back; docs/architecture.md).
inline constexpr std::string_view kDefaultUrl = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";

// URL of the lockstep protocol: grants use this port, answers the next.
inline constexpr std::string_view kDefaultSyncUrl = "udpm://239.255.76.67:7677?ttl=0&recv_buf_size=4194304";

// Returns nothing for a URL without a port.
std::optional<std::uint16_t> port_of(const std::string& url);
// Returns the same URL with the next port; throws InvalidArgument for a URL without a port.
std::string next_port(const std::string& url);

// Returns `given` if not empty, otherwise LCM_DEFAULT_URL, otherwise kDefaultUrl. For udpm, recv_buf_size is
// added if it is missing.
std::string effective_url(const std::string& given);

// The network cannot be used; the message says how to fix it.
class NetworkError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Throws InvalidArgument for a URL whose provider cannot carry a simulation (allowed are udpm:// and
// memq://), and NetworkError if LCM cannot open it.
std::unique_ptr<lcm::LCM> open_transport(const std::string& url);

// Warns the user, once per process, that LCM's socket has no filter (sending/datagram_filter.h).
void warn_of_missing_filter();

// Returns a warning for the user when the kernel grants less receive buffer than requested; empty when it
// grants enough.
[[nodiscard]] std::string receive_buffer_warning(const std::string& url);

}  // namespace halocline::bus
