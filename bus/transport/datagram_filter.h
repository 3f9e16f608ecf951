// SPDX-License-Identifier: BSD-3-Clause
// Packet filter in the kernel that drops datagrams that are no valid part of an LCM message, before LCM reads
// them.
//
// LCM 1.3.1 trusts the header of a fragment: it adds offset and length in 32 bits, compares the sum with the
// message's size, and copies, so that an offset near 2^32 makes it write 4 GiB beyond its buffer
// (lcm-proj/lcm pull request 628). A header that is cut off, a channel without its end, and a short message
// that ends within its channel give it negative lengths, which it takes for 4 GiB. A classic packet filter
// (McCanne and Jacobson 1993, "The BSD packet filter") on LCM's socket passes only
//
// - short messages ("LC02") whose channel, of at most 63 characters, ends within the datagram;
// - fragments ("LC03") with a complete header; a size of 1 to kMaxMessageBytes, below count times the
//   capacity of a datagram; a number below the count; a payload that lies within the size, and for the last
//   fragment reaches its end; and, for number 0, the offset 0 and a channel as above.
//
// Conditions that only several datagrams together show are left to LCM. It holds one unfinished message per
// sender, drops it when the number or the size of the message changes, compares offset and length (which can
// no longer overflow) with that size, and counts fragments without recognising repeated ones. A message can
// thus be delivered with gaps of old memory, which decoders treat as arbitrary bytes.
//
// LCM reads from the moment it binds its socket, so a filter attached afterwards would be too late in a
// flood. bus/transport/transport.cc therefore replaces the C library's bind(), and attaches the filter first
// for sockets of LCM. This works in programs that call open_transport(), link it statically, and link LCM as
// a shared library; in others, receive_filter.h attaches the filter as soon as LCM has its socket.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <linux/filter.h>

namespace halocline::bus {

// Size of the largest message that is received in fragments, bytes. Halocline's own messages stay below 1 MB
// (docs/reliability.md); LCM 1.3.1 keeps 2^24 bytes of unfinished messages, and accepts messages up to 2^28.
inline constexpr std::uint32_t kMaxMessageBytes = 1u << 24;

using FilterProgram = std::vector<sock_filter>;  // jumps lead forward, within it or to its end

inline constexpr std::uint32_t kFilterPasses = 0xffffffff, kFilterDrops = 0;
// Offset of the channel in LCM's short message, after 8 bytes of UDP header and 8 of LCM.
inline constexpr std::uint32_t kShortChannelAt = 16;

sock_filter filter_statement(unsigned code, std::uint32_t value);
sock_filter filter_jump(unsigned code, std::uint32_t value, std::size_t if_true, std::size_t if_false);

// Returns the filter described above. `first` is executed before it, and either returns or continues at its
// end. `of_shorts` is executed for short messages: it returns for those that it decides, and continues at its
// end for those whose channel's end is to be checked.
FilterProgram datagram_program(const FilterProgram& first = {}, const FilterProgram& of_shorts = {});

// Attaches a program in place of the previous one, which stays if the kernel refuses the new one.
[[nodiscard]] bool attach_filter(int socket, FilterProgram program);

}  // namespace halocline::bus
