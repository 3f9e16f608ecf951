#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle with a modem in Python, of LCM and the message types alone.

It circles, announces its modem, sends packets, and prints what becomes of them and what it receives. By hand, from the root of
the tree (clients/examples/README.md has the same in other languages); lcm.py beside it serves where LCM's own module is not installed:

   $ mkdir -p build/mine && lcm-gen --python --ppath build/mine lcmtypes/*.lcm
   $ PYTHONPATH=build/mine ./scripts/join python3 clients/examples/python/foreign_vehicle.py --name visitor --id 77 --to 1
"""
import argparse
import math
import random
import sys
import time

import lcm
from halocline import (modem_config_t, modem_receipt_t, modem_receive_t, modem_send_t, packet_outcome_t, sim_clock_t,
                       vehicle_state_t)

RADIUS_M, SPEED_MPS, REPEAT_S = 100.0, 1.5, 0.5
OUTCOMES = (  # by the number in packet_outcome_t
    "received", "below cutoff", "receiver gone", "shadow", "blocked", "out of band", "collided", "half duplex", "doppler",
    "bit errors", "not acquired", "foreign", "too weak", "too steep", "out of reach", "asleep", "extra loss", "no power",
    "out of water", "no terrain")
STATE_PERIOD_US, MODEM_PERIOD_US = 100_000, 10_000_000


class Timer:
    """Due once in `period_us`, and after time has jumped."""

    def __init__(self, period_us):
        self.period_us, self.next_us = period_us, 0

    def due(self, now):
        if self.period_us == 0 or (now < self.next_us and self.next_us - now <= self.period_us):
            return False
        in_phase = self.next_us > 0 and abs(now - self.next_us) < self.period_us
        self.next_us = (self.next_us if in_phase else now) + self.period_us
        return True


class Vehicle:
    def __init__(self, bus, options):
        self.bus, self.options = bus, options
        self.session = random.SystemRandom().randrange(1, 2**32)  # another one at each start
        self.states = self.packets = self.idle_steps = 0
        self.state_timer, self.modem_timer = Timer(STATE_PERIOD_US), Timer(MODEM_PERIOD_US)
        self.packet_timer = Timer(round(options.every * 1e6))
        self.clock = self.clock_s = None  # the last, and the wall clock then
        self.pending, self.sent_s = None, 0  # waits for its RECEIPT
        self.handlers = {"CLOCK": self.on_clock, "OUTCOME": self.on_outcome, f"RECEIPT.{options.name}": self.on_receipt,
                         f"RECEIVE.{options.name}": self.on_packet}
        bus.subscribe(rf"CLOCK|OUTCOME|(RECEIPT|RECEIVE)\.{options.name}", self.on_message).set_queue_capacity(0)

    def step(self):
        """Does what is due. Simulation time is the last CLOCK, extrapolated by the wall clock at its rate."""
        if self.clock is None:
            self.idle_steps += 1
            if self.idle_steps == 300:  # of 10 ms
                print("no CLOCK for 3 s: start this by ./scripts/join", file=sys.stderr)
            return
        now = self.clock.utime + round((time.monotonic() - self.clock_s) * self.clock.clock_rate * 1e6)
        if self.state_timer.due(now):
            self.publish_state(now)
        if self.modem_timer.due(now):
            self.publish_modem(now)
        if self.pending is None and self.states > 10 and self.packet_timer.due(now):
            self.prepare_packet(now)
        if self.pending and time.monotonic() - self.sent_s > REPEAT_S:
            self.bus.publish(f"SEND.{self.options.name}", self.pending.encode())  # unchanged until its RECEIPT
            self.sent_s = time.monotonic()

    def publish_state(self, now):
        turn = SPEED_MPS / RADIUS_M  # rad/s, clockwise
        angle = now * 1e-6 * turn
        heading = angle + math.pi / 2
        state = vehicle_state_t()
        state.utime, state.session, state.sequence = now, self.session, self.states
        state.vehicle_id = self.options.id
        state.position_ned_m = [self.options.north + RADIUS_M * math.cos(angle), RADIUS_M * math.sin(angle), self.options.depth]
        state.orientation_wxyz = [math.cos(heading / 2), 0.0, 0.0, math.sin(heading / 2)]
        state.velocity_ned_mps = [SPEED_MPS * math.cos(heading), SPEED_MPS * math.sin(heading), 0.0]
        state.angular_velocity_body_radps = [0.0, 0.0, turn]
        self.bus.publish(f"STATE.{self.options.name}", state.encode())
        self.states += 1

    def publish_modem(self, now):
        modem = modem_config_t()
        modem.utime, modem.family, modem.modem_profile = now, self.options.family, "generic"
        modem.source_level_db, modem.center_frequency_hz, modem.bandwidth_hz = 185.0, self.options.center_hz, 5000.0
        modem.bit_rate_bps, modem.packet_overhead_s, modem.max_payload_bytes = 640.0, 0.1, 256
        modem.guard_time_s = 0.02
        modem.doppler_tolerance = modem.doppler_correction = 0.1
        modem.error_model = modem_config_t.ERRORS_JANUS
        self.bus.publish(f"MODEM.{self.options.name}", modem.encode())

    def prepare_packet(self, now):
        packet = modem_send_t()
        packet.utime, packet.session, packet.packet_sequence = now, self.session, self.packets
        packet.source_id, packet.destination_id = self.options.id, self.options.to
        packet.packet_kind, packet.stamped = modem_send_t.DATA, True
        packet.payload = f"hello {self.packets} from {self.options.name}".encode()
        packet.payload_size = len(packet.payload)
        self.pending, self.sent_s = packet, 0
        self.packets += 1

    def on_message(self, channel, data):
        try:
            self.handlers[channel](data)
        except Exception as error:  # what does not decode
            print(f"{channel}: {error}", file=sys.stderr)

    def on_clock(self, data):
        self.clock, self.clock_s = sim_clock_t.decode(data), time.monotonic()

    def on_receipt(self, data):
        receipt = modem_receipt_t.decode(data)
        if receipt.send_session != self.session:
            return
        if self.pending and receipt.packet_sequence == self.pending.packet_sequence:
            self.pending = None
        print(f"{receipt.utime * 1e-6:.3f} s: packet {receipt.packet_sequence} "
              f"{'accepted' if receipt.start_utime else 'refused'}, receipt {receipt.receipt_result}, "
              f"{receipt.duration_s:.3f} s long", flush=True)

    def on_outcome(self, data):
        outcome = packet_outcome_t.decode(data)
        if outcome.send_session == self.session and outcome.source_id == self.options.id:
            word = OUTCOMES[outcome.outcome] if outcome.outcome < len(OUTCOMES) else "?"
            print(f"{outcome.utime * 1e-6:.3f} s: packet {outcome.packet_sequence} at vehicle {outcome.receiver_id}: {word}",
                  flush=True)

    def on_packet(self, data):
        packet = modem_receive_t.decode(data)
        text = "".join(chr(c) if 32 <= c < 127 else "." for c in packet.payload)
        print(f"{packet.utime * 1e-6:.3f} s: from vehicle {packet.source_id}, {packet.snr_db:.3f} dB SNR: {text}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--name", default="visitor")
    parser.add_argument("--id", type=int, default=77)
    parser.add_argument("--to", type=int, default=0, help="vehicle to send to; 0: all")
    parser.add_argument("--north", type=float, default=0.0, help="centre of the circle, m")
    parser.add_argument("--depth", type=float, default=50.0, help="m")
    parser.add_argument("--every", type=float, default=10.0, help="seconds from packet to packet; 0: none")
    parser.add_argument("--family", default="generic", help="waveform family of the modem")
    parser.add_argument("--center-hz", type=float, default=25000.0, help="of the modem")
    bus = lcm.LCM()
    vehicle = Vehicle(bus, parser.parse_args())
    while True:
        bus.handle_timeout(10)
        vehicle.step()


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        pass
    except OSError as error:
        print(f"LCM cannot be used: {error}; see LCM_DEFAULT_URL", file=sys.stderr)
        sys.exit(69)
