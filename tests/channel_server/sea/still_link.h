// SPDX-License-Identifier: BSD-3-Clause
// One link between two points at rest, and packets over it, decided as the medium decides them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "acoustics/fading/link_fading.h"
#include "acoustics/fading/path_fading.h"
#include "acoustics/modem/modem.h"
#include "acoustics/modem/packet_format.h"
#include "acoustics/prediction/link_prediction.h"
#include "acoustics/reception/guard_window.h"
#include "acoustics/reception/reception_curves.h"
#include "acoustics/reception/signal_history.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/reception_decision.h"
#include "channel_server/propagation/propagation.h"
#include "core/random.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::channel_server::testing {

class StillLink {
 public:
  // `noise` in dB re 1 uPa over the band; `pair` numbers the link.
  StillLink(Reception reception, const acoustics::Modem& modem, std::size_t payload_bytes,
            const acoustics::FadingModel& model, std::uint32_t pair, Decibels noise)
      : reception_(std::move(reception)),
        modem_(modem),
        model_(model),
        link_{.seed = 1, .lower_id = pair, .higher_id = pair + 1'000'000},
        noise_(to_power_ratio(noise).value),
        window_(reception_.paths.empty() ? acoustics::GuardWindow() : best_window(reception_.paths, modem_)) {
    Packet packet;
    packet.modem = modem_;
    packet.format = data_format(modem_, payload_bytes);
    packet.timing = packet_timing(modem_, packet.format);
    packet_ = std::make_shared<const Packet>(packet);
  }
  StillLink(const StillLink&) = delete;

  // The probability that a packet that begins to sound at `time_s` is received.
  double delivery(double time_s) const {
    if (reception_.paths.empty()) return 0;
    const SimTime begin = SimTime::from_seconds(time_s);
    const acoustics::PacketTiming& timing = packet_->timing;
    ReceivedSignal signal{packet_,        noise_, begin, begin + timing.preamble, begin + timing.duration,
                          model_.enabled, {},     {}};
    signal.history = signal_history(model_, link_, acoustics::LinkFading(model_, link_).large_scale(begin),
                                    reception_.paths, sync_, modem_.band(), begin,
                                    {timing.preamble.seconds(), timing.duration.seconds()});
    return acquisition_probability(signal, {}) * success_probability(signal, {});
  }
  // Whether it is, by an addressed draw.
  bool delivers(double time_s) const {
    return uniform_at(
               {.seed = 2, .who = link_.lower_id, .which = static_cast<std::uint64_t>(time_s * 1000)}) <
           delivery(time_s);
  }
  acoustics::LinkPrediction prediction(const acoustics::ReceptionCurves& curves) const {
    return predict_link(model_, reception_.paths, sync_, modem_.band(), noise_, curves);
  }
  const Reception& reception() const { return reception_; }

 private:
  Reception reception_;
  acoustics::Modem modem_;
  acoustics::FadingModel model_;
  acoustics::FadingLink link_;
  double noise_;
  acoustics::GuardWindow window_;
  acoustics::Synchronisation sync_{&modem_, window_};
  PacketPointer packet_;
};

}  // namespace halocline::channel_server::testing
