// SPDX-License-Identifier: BSD-3-Clause
#include "bus/transport/datagram_filter.h"

#include <utility>

#include <sys/socket.h>

namespace halocline::bus {
namespace {

constexpr std::uint32_t kShortWord = 0x4c433032, kFragmentWord = 0x4c433033;  // "LC02", "LC03"
constexpr std::uint32_t kMaxChannelBytes = 64;                                // with the terminating 0
// Offsets in a datagram, including 8 bytes of UDP header (liblcm, udpm_util.h: lcm2_header_long_t).
constexpr std::uint32_t kWordAt = 8, kSizeAt = 16, kOffsetAt = 20, kNumberAt = 24, kCountAt = 26,
                        kPartAt = 28;
constexpr std::uint32_t kMaxPartBytes = 65'487;  // 65 507 of a UDP datagram minus LCM's header
// Indices of the filter's scratch memory.
constexpr std::uint32_t kRoom = 0, kPayload = 1, kChannelBytes = 2;

class Assembler {
 public:
  explicit Assembler(FilterProgram program) : program_(std::move(program)) {}

  void add(unsigned code, std::uint32_t value = 0) { program_.push_back(filter_statement(code, value)); }
  void add(const FilterProgram& part) { program_.insert(program_.end(), part.begin(), part.end()); }
  void load_word(std::uint32_t at) { add(BPF_LD | BPF_W | BPF_ABS, at); }
  void load_half(std::uint32_t at) { add(BPF_LD | BPF_H | BPF_ABS, at); }
  void load_length() { add(BPF_LD | BPF_W | BPF_LEN); }
  // Drops the datagram if the comparison of the accumulator with `value`, or with the index register, holds.
  void drop_if(unsigned comparison, std::uint32_t value) {
    program_.push_back(filter_jump(comparison, value, 0, 1));
    add(BPF_RET | BPF_K, kFilterDrops);
  }
  void drop_if_x(unsigned comparison) {
    drop_if(comparison, 0);
    program_[program_.size() - 2].code |= BPF_X;
  }
  // Appends a jump to the place where land() is called with the return value. leap() always jumps, leap_if()
  // only if the accumulator is `value`.
  std::size_t leap() {
    add(BPF_JMP | BPF_JA);
    return program_.size() - 1;
  }
  std::size_t leap_if(std::uint32_t value) {
    program_.push_back(filter_jump(BPF_JEQ, value, 0, 1));
    return leap();
  }
  void land(std::size_t leap) { program_[leap].k = static_cast<std::uint32_t>(program_.size() - leap - 1); }
  FilterProgram take() { return std::move(program_); }

 private:
  FilterProgram program_;
};

// Drops datagrams with an invalid fragment header. Stores the bytes between offset and size of the message in
// kRoom, and those of the payload in kPayload.
void check_header(Assembler& to) {
  to.load_length();
  to.add(BPF_ALU | BPF_SUB | BPF_K, kPartAt);
  to.add(BPF_ST, kPayload);
  to.load_half(kCountAt);  // drops the datagram if the header is incomplete
  to.add(BPF_ALU | BPF_MUL | BPF_K, kMaxPartBytes);
  to.add(BPF_MISC | BPF_TAX);
  to.load_word(kSizeAt);
  to.drop_if(BPF_JEQ, 0);
  to.drop_if(BPF_JGT, kMaxMessageBytes);
  to.drop_if_x(BPF_JGE);
  to.add(BPF_MISC | BPF_TAX);
  to.load_word(kOffsetAt);
  to.drop_if_x(BPF_JGT);
  to.add(BPF_MISC | BPF_TAX);
  to.load_word(kSizeAt);
  to.add(BPF_ALU | BPF_SUB | BPF_X);
  to.add(BPF_ST, kRoom);
  to.load_half(kCountAt);
  to.add(BPF_MISC | BPF_TAX);
  to.load_half(kNumberAt);
  to.drop_if_x(BPF_JGE);
}

// Searches for the end of the channel, from the index register on; leaves the channel's length, with the 0,
// in the accumulator.
void find_channel_end(Assembler& to) {
  std::vector<std::size_t> found;
  for (std::uint32_t i = 0; i < kMaxChannelBytes; ++i) {
    to.add(BPF_LD | BPF_B | BPF_IND, i);  // drops the datagram at its end
    to.add({filter_jump(BPF_JEQ, 0, 0, 2)});
    to.add(BPF_LD | BPF_W | BPF_IMM, i + 1);
    found.push_back(to.leap());
  }
  to.add(BPF_RET | BPF_K, kFilterDrops);
  for (const std::size_t one : found) to.land(one);
}

void check_payload(Assembler& to) {
  to.add(BPF_LDX | BPF_W | BPF_MEM, kRoom);
  to.add(BPF_LD | BPF_W | BPF_MEM, kPayload);
  to.drop_if_x(BPF_JGT);
  to.load_half(kNumberAt);
  to.add(BPF_ALU | BPF_ADD | BPF_K, 1);
  to.add(BPF_MISC | BPF_TAX);
  to.load_half(kCountAt);
  to.add({filter_jump(BPF_JEQ | BPF_X, 0, 1, 0)});
  to.add(BPF_RET | BPF_K, kFilterPasses);  // not the last fragment
  to.add(BPF_LDX | BPF_W | BPF_MEM, kRoom);
  to.add(BPF_LD | BPF_W | BPF_MEM, kPayload);
  to.add({filter_jump(BPF_JEQ | BPF_X, 0, 0, 1)});
  to.add(BPF_RET | BPF_K, kFilterPasses);
  to.add(BPF_RET | BPF_K, kFilterDrops);
}

}  // namespace

sock_filter filter_statement(unsigned code, std::uint32_t value) {
  return {static_cast<std::uint16_t>(code), 0, 0, value};
}

sock_filter filter_jump(unsigned code, std::uint32_t value, std::size_t if_true, std::size_t if_false) {
  return {static_cast<std::uint16_t>(BPF_JMP | code), static_cast<std::uint8_t>(if_true),
          static_cast<std::uint8_t>(if_false), value};
}

FilterProgram datagram_program(const FilterProgram& first, const FilterProgram& of_shorts) {
  Assembler to(first);
  to.load_word(kWordAt);
  const std::size_t to_fragments = to.leap_if(kFragmentWord);
  to.add({filter_jump(BPF_JEQ, kShortWord, 1, 0)});
  to.add(BPF_RET | BPF_K, kFilterDrops);
  to.add(of_shorts);
  to.add(BPF_ST, kRoom);  // not read for a short message, but the kernel cannot know
  to.add(BPF_ST, kPayload);
  to.add(BPF_LDX | BPF_W | BPF_IMM, kShortChannelAt);
  const std::size_t of_short = to.leap();
  to.land(to_fragments);
  check_header(to);
  to.add({filter_jump(BPF_JEQ, 0, 1, 0)});
  const std::size_t to_rest = to.leap();
  to.load_word(kOffsetAt);
  to.add({filter_jump(BPF_JEQ, 0, 1, 0)});
  to.add(BPF_RET | BPF_K, kFilterDrops);
  to.add(BPF_LDX | BPF_W | BPF_IMM, kPartAt);
  to.land(of_short);
  find_channel_end(to);
  to.add(BPF_ST, kChannelBytes);
  to.add(BPF_MISC | BPF_TXA);
  to.add({filter_jump(BPF_JEQ, kPartAt, 1, 0)});
  to.add(BPF_RET | BPF_K, kFilterPasses);
  to.add(BPF_LDX | BPF_W | BPF_MEM, kChannelBytes);
  to.add(BPF_LD | BPF_W | BPF_MEM, kPayload);
  to.add(BPF_ALU | BPF_SUB | BPF_X);
  to.add(BPF_ST, kPayload);
  to.land(to_rest);
  check_payload(to);
  return to.take();
}

bool attach_filter(int socket, FilterProgram program) {
  const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
  return setsockopt(socket, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter) == 0;
}

}  // namespace halocline::bus
