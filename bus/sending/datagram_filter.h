// SPDX-License-Identifier: BSD-3-Clause
// Leaves out, in the kernel, datagrams that are no sound part of an LCM message, before LCM reads them.
//
// LCM 1.3.1 believes the header of a fragment: it adds offset and length in 32 bits, compares the sum with
// the message's size, and copies, so that an offset near 2^32 makes it write 4 GiB behind its buffer
// (lcm-proj/lcm pull request 628). A header cut short, a channel without its end and a short message that
// ends within its channel give it lengths below zero, which it takes for 4 GiB. A classic packet filter
// (McCanne and Jacobson 1993, "The BSD packet filter") on its socket lets pass
//   short messages ("LC02") whose channel, of 63 characters at most, ends within the datagram;
//   fragments ("LC03") with a whole header; a size of 1 to kMaxMessageBytes, below count times what a
//   datagram holds; a number below the count; a payload that lies within the size, and for the last of
//   the count reaches its end; and, for number 0, the offset 0 and a channel as above.
// and nothing else. What only several datagrams together show remains with LCM: it holds one unfinished
// message a sender, drops it when the number or the size of the message changes, compares offset and length
// (which no longer wrap) with that size, and counts fragments without telling repeated ones apart, so that
// a message can be delivered with holes of old memory, which decoders take as any bytes.
//
// LCM reads from the moment it binds its socket, so that a filter attached afterwards comes too late for a
// flood. bus/transport.cc defines bind(): that of the C library, and for sockets of LCM the filter first. It
// holds in programs that call open_transport(), and link it statically and LCM as a shared library; in
// others, receive_filter.h attaches it as soon as LCM has its socket.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <linux/filter.h>

namespace halocline::bus {

// Bytes of the largest message that is received in fragments. Halocline's own stay below 1 MB
// (docs/bus.md); LCM 1.3.1 keeps 2^24 bytes of unfinished messages, and takes messages up to 2^28.
inline constexpr std::uint32_t kMaxMessageBytes = 1u << 24;

using FilterProgram = std::vector<sock_filter>;  // jumps lead forward, within it or to its end

inline constexpr std::uint32_t kFilterPasses = 0xffffffff, kFilterDrops = 0;
// Offset of LCM's short header's channel, behind 8 bytes of UDP and 8 of LCM.
inline constexpr std::uint32_t kShortChannelAt = 16;

sock_filter filter_statement(unsigned code, std::uint32_t value);
sock_filter filter_jump(unsigned code, std::uint32_t value, std::size_t if_true, std::size_t if_false);

// The filter described above. `first` is run before, and ends with a return or goes on at its end.
// `of_shorts` is run for short messages: it returns for those whose fate it knows, and goes on at its end
// for those whose channel's end is to be looked for.
FilterProgram datagram_program(const FilterProgram& first = {}, const FilterProgram& of_shorts = {});

// Attaches a program in the place of the one before, which stays where the kernel refuses the new one.
[[nodiscard]] bool attach_filter(int socket, FilterProgram program);

}  // namespace halocline::bus
