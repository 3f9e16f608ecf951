#!/usr/bin/env python3
"""A vehicle of your own in Python: publishes its pose, sends a packet now and then, prints what it receives.

It circles at 50 m of depth. ./scripts/types makes the message types (build/types/python):
    PYTHONPATH=build/types/python ./scripts/join python3 clients/examples/foreign_vehicle.py visitor 77 [SECONDS]
"""
import math
import sys
import time

import lcm
from halocline import modem_receipt_t, modem_receive_t, modem_send_t, sim_clock_t, vehicle_state_t

RADIUS_M, SPEED_MPS, DEPTH_M = 100.0, 1.5, 50.0
STATE_PERIOD_S, SEND_PERIOD_S = 0.1, 5.0


class Vehicle:
    def __init__(self, bus, name, vehicle_id):
        self.bus, self.name, self.id = bus, name, vehicle_id
        self.session, self.states, self.packets = time.time_ns(), 0, 0
        self.clock = None  # (simulation time, s; rate; wall time of its reception, s)
        bus.subscribe("CLOCK", self.on_clock)
        bus.subscribe(rf"RECEIVE\.{name}", self.on_packet)
        bus.subscribe(rf"RECEIPT\.{name}", self.on_receipt)

    def on_clock(self, _, data):
        clock = sim_clock_t.decode(data)
        self.clock = (clock.utime * 1e-6, clock.clock_rate, time.monotonic())

    def on_packet(self, _, data):
        packet = modem_receive_t.decode(data)
        print(f"{packet.utime * 1e-6:.3f} s: from vehicle {packet.source_id}, {packet.snr_db:.1f} dB SNR, "
              f"{len(packet.payload)} bytes", flush=True)

    def on_receipt(self, _, data):
        receipt = modem_receipt_t.decode(data)
        if receipt.send_session == self.session:
            accepted = receipt.receipt_result in (modem_receipt_t.ACCEPTED, modem_receipt_t.QUEUED)
            print(f"packet {receipt.packet_sequence}:", "accepted" if accepted else
                  f"refused, reason {receipt.receipt_result}", flush=True)

    def now_s(self):
        """Simulation time: the last CLOCK, extrapolated by the wall clock at its rate."""
        simulated_s, rate, received_s = self.clock
        return simulated_s + rate * (time.monotonic() - received_s)

    def publish_state(self, now_s):
        turn = SPEED_MPS / RADIUS_M  # rad/s
        angle = turn * now_s
        heading = angle + math.pi / 2
        state = vehicle_state_t()
        state.utime, state.session, state.sequence = round(now_s * 1e6), self.session, self.states
        state.vehicle_id = self.id
        state.position_ned_m = [RADIUS_M * math.cos(angle), RADIUS_M * math.sin(angle), DEPTH_M]
        state.orientation_wxyz = [math.cos(heading / 2), 0.0, 0.0, math.sin(heading / 2)]
        state.velocity_ned_mps = [SPEED_MPS * math.cos(heading), SPEED_MPS * math.sin(heading), 0.0]
        state.angular_velocity_body_radps = [0.0, 0.0, turn]
        self.bus.publish(f"STATE.{self.name}", state.encode())
        self.states += 1

    def send(self, now_s, text):
        packet = modem_send_t()
        packet.utime, packet.session, packet.packet_sequence = round(now_s * 1e6), self.session, self.packets
        packet.source_id, packet.destination_id = self.id, 0  # 0: to all
        packet.packet_kind, packet.stamped = modem_send_t.DATA, True
        packet.payload, packet.payload_size = text.encode(), len(text)
        self.bus.publish(f"SEND.{self.name}", packet.encode())
        self.packets += 1


def main(name="visitor", vehicle_id="77", seconds="inf"):
    bus = lcm.LCM()
    vehicle = Vehicle(bus, name, int(vehicle_id))
    started_s, warned = time.monotonic(), False
    next_state_s = next_send_s = -math.inf
    while time.monotonic() - started_s < float(seconds):
        bus.handle_timeout(10)
        if vehicle.clock is None:
            if not warned and time.monotonic() - started_s > 3:
                warned = True
                print("no CLOCK for 3 s: start this through ./scripts/join", file=sys.stderr)
            continue
        now_s = vehicle.now_s()
        if now_s >= next_state_s:
            vehicle.publish_state(now_s)
            next_state_s = now_s + STATE_PERIOD_S
        if now_s >= next_send_s and vehicle.states > 10:
            vehicle.send(now_s, f"hello {vehicle.packets} from {name}")
            next_send_s = now_s + SEND_PERIOD_S


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except KeyboardInterrupt:
        pass
