// SPDX-License-Identifier: BSD-3-Clause
// Kinds of receivers: which paths of a packet they collect, and what the others do to them.
//
// - kHops, frequency-hopped FSK: the guard window of greatest power. Later echoes fall on tones that
//   were left, and disturb when the hop pattern returns (guard_window.h). It tracks nothing.
// - kStrongestPath, spread spectrum and sweeps: the strongest path alone, with what the band cannot part from
//   it (Modem::window_s); every other path disturbs by Modem::late_echo_share. It tracks nothing.
// - kEqualiser, phase-shift keying and OFDM: the guard window. It tracks what fades slowly; the rest of the
//   window disturbs (acoustics/reception/signal_history.h). Its feedback cancels the share
//   Modem::echo_cancelled of a later echo that it can track. With frequency-shift keying it tracks nothing.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace halocline::acoustics {

enum class ReceiverKind { kHops, kStrongestPath, kEqualiser };

inline constexpr std::array kReceiverKinds = {ReceiverKind::kHops, ReceiverKind::kStrongestPath,
                                              ReceiverKind::kEqualiser};

// Names of the kinds: "hops", "strongest-path", "equaliser".
constexpr std::string_view to_name(ReceiverKind kind) {
  constexpr std::array<std::string_view, kReceiverKinds.size()> kNames{"hops", "strongest-path", "equaliser"};
  return kNames[static_cast<std::size_t>(kind)];
}

}  // namespace halocline::acoustics
