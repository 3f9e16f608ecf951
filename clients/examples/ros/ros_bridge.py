#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Halocline's bus in ROS 1: what vehicles do as standard messages, every message of the bus as it is, packets both ways.

docs/interfaces.md has all topics and fields, and what ROS 2 needs. By hand, from the root of the tree, with python3-rospy, python3-rosmaster,
python3-nav-msgs and python3-sensor-msgs of Debian 12, beside a run by ./scripts/run --distributed:

   $ mkdir -p build/mine && lcm-gen --python --ppath build/mine lcmtypes/*.lcm
   $ rosmaster --core &
   $ PYTHONPATH=build/mine:clients/examples/python ./scripts/join /usr/bin/python3 clients/examples/ros/ros_bridge.py --vehicle auv-1

For each --vehicle NAME: topics /NAME/... of what the bus holds of it; /NAME/send and /NAME/command are published on the bus. A vehicle
of --moved NAME=ID is moved by ROS: its /NAME/odometry becomes its STATE. In names of ROS, - is _.
"""
import argparse
import importlib
import pathlib
import queue
import random
import threading
import time

import genpy.dynamic
import lcm
import rospy
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock

import ros_mapping
import ros_messages

LCMTYPES = pathlib.Path(__file__).resolve().parents[3] / "lcmtypes"
REPEAT_S = 0.5
# Channels of a vehicle by family, and those of all, with their types: to ROS as they are.
TO_ROS = {"SENSORS": "vehicle_sensors_t", "DVL": "vehicle_dvl_t", "GPS": "vehicle_gps_t", "SONAR": "vehicle_sonar_t",
          "USBL": "vehicle_usbl_t", "BATTERY": "vehicle_battery_t", "ESTIMATE": "position_estimate_t", "STATE": "vehicle_state_t",
          "RECEIPT": "modem_receipt_t", "RECEIVE": "modem_receive_t", "OUTCOME": "packet_outcome_t", "SCENARIO": "scenario_info_t"}
TO_LCM = {"SEND": "modem_send_t", "COMMAND": "vehicle_command_t"}


def lcm_class(name):
    return getattr(importlib.import_module(f"halocline.{name}"), name)


def ros_classes(types):
    """Classes of ROS 1 by LCM names, made now of the definitions; those that catkin builds of ros_messages.py are of the same types."""
    parts = ["".join(f"{ros_messages.ros_type(name)} {name}\n" for name in types)]  # a message of them all
    parts += [f"MSG: {ros_messages.ros_type(name)}\n{message.definition()}" for name, message in types.items()]
    made = genpy.dynamic.generate_dynamic(f"{ros_messages.PACKAGE}/All", ("=" * 80 + "\n").join(parts))
    return {name: made[ros_messages.ros_type(name)] for name in types}


def stamp(utime):
    return rospy.Time(utime // 1_000_000, utime % 1_000_000 * 1000)


class Bridge:
    def __init__(self, bus, options):
        self.bus = bus
        types = ros_messages.message_types(options.lcmtypes)
        self.classes = ros_classes(types)
        self.converter = ros_messages.Converter(types, lcm_class, self.classes.__getitem__)
        self.publishers = {}
        self.to_send = queue.Queue()  # from rospy's threads: LCM is used by one
        self.now = 0
        self.session = random.SystemRandom().randrange(1, 2**32)
        self.states = dict.fromkeys(options.moved, 0)
        self.pending = {}  # SENDs that wait for their RECEIPT: (channel, bytes, wall clock of the last attempt)
        self.lock = threading.Lock()
        self.vehicles = set(options.vehicle) | set(options.moved)
        for vehicle in self.vehicles:
            for family, name in TO_LCM.items():
                rospy.Subscriber(self.topic(vehicle, family), self.classes[name], self.on_ros, (vehicle, family, name))
        for vehicle, number in options.moved.items():
            rospy.Subscriber(self.topic(vehicle, "odometry"), Odometry, self.on_odometry, (vehicle, number))
        families = "|".join(TO_ROS)
        bus.subscribe(rf"CLOCK|({families})(\..+)?", self.on_lcm).set_queue_capacity(0)

    @staticmethod
    def topic(vehicle, name):
        return f"/{vehicle.replace('-', '_')}/{name.lower()}"

    def publish(self, topic, message):
        if topic not in self.publishers:
            self.publishers[topic] = rospy.Publisher(topic, type(message), queue_size=100, latch=topic.endswith("/scenario"))
        self.publishers[topic].publish(message)

    def on_lcm(self, channel, data):
        """One message of the bus; what does not decode is left out."""
        family, _, vehicle = channel.partition(".")
        try:
            message = lcm_class("sim_clock_t" if channel == "CLOCK" else TO_ROS[family]).decode(data)
        except Exception as error:
            rospy.logwarn_throttle(10, f"{channel}: {error}")
            return
        if channel == "CLOCK":
            self.now = message.utime
            return self.publish("/clock", Clock(stamp(message.utime)))
        if vehicle and vehicle not in self.vehicles:
            return
        if family == "RECEIPT":
            with self.lock:
                self.pending.pop((vehicle, message.send_session, message.packet_sequence), None)
        self.publish(self.topic(vehicle or "halocline", family), self.converter.to_ros(TO_ROS[family], message))
        for topic, convert in ros_mapping.STANDARD.get(family, {}).items():
            if vehicle in self.states and family == "STATE":
                continue  # it came from there
            made = convert(message, vehicle.replace("-", "_"))
            if made is not None:
                made.header.stamp = stamp(message.utime)
                self.publish(self.topic(vehicle, topic), made)

    def on_ros(self, message, context):
        """A SEND is published unchanged until its RECEIPT; one without a start begins now."""
        vehicle, family, name = context
        out = self.converter.to_lcm(name, message)
        out.utime = out.utime or self.now
        if family == "SEND":
            out.session = out.session or self.session
            with self.lock:
                self.pending[vehicle, out.session, out.packet_sequence] = [f"SEND.{vehicle}", out.encode(), 0.0]
        else:
            self.to_send.put((f"{family}.{vehicle}", out.encode()))

    def on_odometry(self, odometry, context):
        vehicle, number = context
        state = lcm_class("vehicle_state_t")()
        state.utime = odometry.header.stamp.to_nsec() // 1000
        state.session, state.sequence, state.vehicle_id = self.session, self.states[vehicle], number
        self.states[vehicle] += 1
        ros_mapping.set_state(state, odometry)
        self.to_send.put((f"STATE.{vehicle}", state.encode()))

    def step(self):
        self.bus.handle_timeout(10)
        while not self.to_send.empty():
            self.bus.publish(*self.to_send.get())
        with self.lock:
            due = [entry for entry in self.pending.values() if time.monotonic() - entry[2] > REPEAT_S]
        for entry in due:
            entry[2] = time.monotonic()
            self.bus.publish(entry[0], entry[1])


def moved(text):
    name, _, number = text.partition("=")
    if not number.isdigit() or int(number) < 1:
        raise argparse.ArgumentTypeError(f"'{text}': allowed is NAME=ID, a number from 1")
    return name, int(number)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--vehicle", action="append", default=[], metavar="NAME")
    parser.add_argument("--moved", action="append", default=[], type=moved, metavar="NAME=ID")
    parser.add_argument("--lcmtypes", default=LCMTYPES, help="folder of the .lcm files")
    options = parser.parse_args()
    options.moved = dict(options.moved)
    rospy.init_node("halocline", disable_signals=False)
    bridge = Bridge(lcm.LCM(), options)
    while not rospy.is_shutdown():
        bridge.step()


if __name__ == "__main__":
    main()
