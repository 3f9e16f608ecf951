#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests the bridge to ROS 1, with a ROS master and a bus of its own: scripts/isolated tests/clients/ros/bridge_test.py"""
import io
import math
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile
import time
import unittest

TREE = pathlib.Path(__file__).resolve().parents[3]
FOLDER = tempfile.TemporaryDirectory()
subprocess.run(["lcm-gen", "-p", "--ppath", FOLDER.name, *TREE.glob("lcmtypes/*.lcm")], check=True)
PATHS = [FOLDER.name, str(TREE / "clients/examples/python"), str(TREE / "clients/examples/ros")]
sys.path[:0] = PATHS
os.environ.update(ROS_MASTER_URI="http://127.0.0.1:11311", ROS_IP="127.0.0.1", HOME=FOLDER.name, PYTHONPATH=os.pathsep.join(PATHS))

import lcm  # noqa: E402
import rospy  # noqa: E402
from nav_msgs.msg import Odometry  # noqa: E402
from rosgraph_msgs.msg import Clock  # noqa: E402
from sensor_msgs.msg import Range  # noqa: E402

import ros_bridge  # noqa: E402
import ros_mapping  # noqa: E402
import ros_messages  # noqa: E402

TYPES = ros_messages.message_types(TREE / "lcmtypes")
CLASSES = ros_bridge.ros_classes(TYPES)
CONVERTER = ros_messages.Converter(TYPES, ros_bridge.lcm_class, CLASSES.__getitem__)


def filled(name, rng):
    """A message whose every field has a value of its own."""
    draws = {"string": lambda: f"text {rng.random()}", "bool": lambda: rng.random() < 0.5, "float64": rng.random, "uint8": lambda: rng.randrange(256),
             "float32": lambda: rng.randrange(1000) / 8, "int8": lambda: rng.randrange(-128, 128), "int16": lambda: rng.randrange(-999, 999),
             "int32": lambda: rng.randrange(-2**31, 2**31), "int64": lambda: rng.randrange(-2**63, 2**63)}
    message, counts = ros_bridge.lcm_class(name)(), {}
    for f in TYPES[name].fields:
        sizes = [size if isinstance(size, int) else counts.setdefault(size, rng.randrange(1, 4)) for size in f.sizes]
        draw = (lambda f=f: filled(f.nested, rng)) if f.nested else draws[f.kind]

        def value(left):
            return [value(left[1:]) for _ in range(left[0])] if left else draw()
        made = value(sizes)
        setattr(message, f.name, bytes(made) if f.sizes and f.kind == "uint8" else made)
    for size, count in counts.items():
        setattr(message, size, count)
    return message


def product(a, b):
    return [[sum(x * y for x, y in zip(row, column)) for column in zip(*b)] for row in a]


def unit(rng):
    q = [rng.gauss(0, 1) for _ in range(4)]
    norm = math.sqrt(sum(x * x for x in q))
    return [x / norm for x in q]


E = [[0, 1, 0], [1, 0, 0], [0, 0, -1]]
F = [[1, 0, 0], [0, -1, 0], [0, 0, -1]]


class Frames(unittest.TestCase):
    def assert_close(self, a, b):
        for x, y in zip(a, b, strict=True):
            self.assertAlmostEqual(x, y, delta=1e-12)

    def test_the_quaternion_is_that_of_the_matrices(self):
        rng = random.Random(1)
        for _ in range(100):
            q = unit(rng)
            for ours, theirs in zip(ros_mapping.rotation(ros_mapping.turned(q)), product(product(E, ros_mapping.rotation(q)), F)):
                self.assert_close(ours, theirs)
            self.assert_close(ros_mapping.turned(ros_mapping.turned(q)), q)

    def test_heading_pitch_and_roll_turn_about_down_starboard_and_forward(self):
        h, p, r = 0.7, -0.3, 0.2
        ch, sh, cp, sp, cr, sr = (f(a) for a in (h, p, r) for f in (math.cos, math.sin))
        about = product(product([[ch, -sh, 0], [sh, ch, 0], [0, 0, 1]], [[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]]),
                        [[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
        for ours, theirs in zip(ros_mapping.rotation(ros_mapping.quaternion(h, p, r)), about):
            self.assert_close(ours, theirs)

    def test_a_vehicle_that_goes_east_and_down_does_so_in_ros(self):
        state = ros_bridge.lcm_class("vehicle_state_t")()
        state.position_ned_m = [10.0, 20.0, 30.0]
        state.orientation_wxyz = list(ros_mapping.quaternion(math.pi / 2, 0, 0))  # heads east
        state.velocity_ned_mps = [0.0, 2.0, 0.5]
        state.angular_velocity_body_radps = [0.1, 0.2, 0.3]  # turns to starboard: clockwise from above
        odometry = ros_mapping.odometry(state, "auv_1")
        pose, twist = odometry.pose.pose, odometry.twist.twist
        self.assertEqual((pose.position.x, pose.position.y, pose.position.z), (20, 10, -30))
        self.assertAlmostEqual(abs(pose.orientation.w), 1, delta=1e-12)  # x forward is x east
        self.assert_close((twist.linear.x, twist.linear.y, twist.linear.z), (2, 0, -0.5))
        self.assert_close((twist.angular.x, twist.angular.y, twist.angular.z), (0.1, -0.2, -0.3))

    def test_a_state_comes_back_as_it_was(self):
        rng = random.Random(2)
        for _ in range(20):
            state, back = ros_bridge.lcm_class("vehicle_state_t")(), ros_bridge.lcm_class("vehicle_state_t")()
            state.position_ned_m, state.orientation_wxyz = [rng.gauss(0, 100) for _ in range(3)], unit(rng)
            state.velocity_ned_mps, state.angular_velocity_body_radps = ([rng.gauss(0, 1) for _ in range(3)] for _ in range(2))
            ros_mapping.set_state(back, ros_mapping.odometry(state, "a"))
            for name in ("position_ned_m", "orientation_wxyz", "velocity_ned_mps", "angular_velocity_body_radps"):
                self.assert_close(getattr(back, name), getattr(state, name))


class Sensors(unittest.TestCase):
    def test_what_is_not_fresh_is_not_measured(self):
        sensors = ros_bridge.lcm_class("vehicle_sensors_t")()
        sensors.altitude_status = sensors.ALTITUDE_UNAVAILABLE
        for convert in ros_mapping.STANDARD["SENSORS"].values():
            self.assertIsNone(convert(sensors, "a"))
        sensors.angular_rate_fresh, sensors.angular_rate_body_radps = True, [1.0, 2.0, 3.0]
        imu = ros_mapping.imu(sensors, "a")
        self.assertEqual((imu.orientation_covariance[0], imu.angular_velocity_covariance[0], imu.linear_acceleration_covariance[0]), (-1, 0, -1))
        self.assertEqual((imu.angular_velocity.x, imu.angular_velocity.y, imu.angular_velocity.z), (1, -2, -3))

    def test_an_altimeter_without_a_bottom_reads_infinity(self):
        sensors = ros_bridge.lcm_class("vehicle_sensors_t")()
        sensors.altitude_status = sensors.ALTITUDE_NO_BOTTOM
        self.assertEqual(ros_mapping.altitude(sensors, "a").range, math.inf)
        sensors.altitude_status, sensors.altitude_m = sensors.ALTITUDE_MEASURED, 12.5
        self.assertEqual(ros_mapping.altitude(sensors, "a").range, 12.5)

    def test_a_scan_goes_from_starboard_to_port(self):
        sonar = ros_bridge.lcm_class("vehicle_sonar_t")()
        sonar.fan_azimuth_rad, sonar.max_range_m = [-0.2, 0.0, 0.2], 50.0
        sonar.echo_status, sonar.echo_range_m = [sonar.ECHO, sonar.ECHO_NONE, sonar.ECHO_UNAVAILABLE], [7.0, 0.0, 0.0]
        scan = ros_mapping.sonar(sonar, "a")
        self.assertEqual((scan.angle_min, scan.angle_max), (-0.2, 0.2))
        self.assertTrue(math.isnan(scan.ranges[0]))
        self.assertEqual(scan.ranges[1:], [math.inf, 7])  # port, azimuth -0.2, is last
        sonar.fan_azimuth_rad = [-0.2, 0.1, 0.2]
        self.assertIsNone(ros_mapping.sonar(sonar, "a"))

    def test_a_covariance_turns_with_its_position(self):
        estimate = ros_bridge.lcm_class("position_estimate_t")()
        estimate.estimate_status, estimate.position_ned_m = estimate.UNIQUE, [1.0, 2.0, 3.0]
        c = [[4.0, 1.0, 0.5], [1.0, 9.0, 0.25], [0.5, 0.25, 16.0]]
        estimate.covariance_ned_m2 = [x for row in c for x in row]
        out = ros_mapping.estimate(estimate, "a").pose
        self.assertEqual([list(out.covariance[6 * i:6 * i + 3]) for i in range(3)], product(product(E, c), E))
        self.assertEqual((out.pose.position.x, out.pose.position.y, out.pose.position.z), (2, 1, -3))

    def test_a_direction_to_port_and_up_is_left_and_up(self):
        usbl = ros_bridge.lcm_class("vehicle_usbl_t")()
        usbl.peer_bearing_rad, usbl.peer_elevation_rad = -math.pi / 2, math.pi / 6
        vector = ros_mapping.usbl(usbl, "a").vector
        for ours, theirs in zip((vector.x, vector.y, vector.z), (0, math.cos(math.pi / 6), 0.5)):
            self.assertAlmostEqual(ours, theirs, delta=1e-12)


class Messages(unittest.TestCase):
    def test_every_type_comes_back_byte_for_byte(self):
        rng = random.Random(3)
        for name in TYPES:
            message = filled(name, rng)
            ros = CONVERTER.to_ros(name, message)
            wire = io.BytesIO()
            ros.serialize(wire)
            back = CLASSES[name]()
            back.deserialize(wire.getvalue())
            self.assertEqual(CONVERTER.to_lcm(name, back).encode(), message.encode(), name)

    def test_every_field_and_constant_is_in_the_definition(self):
        for name, message in TYPES.items():
            generated = ros_bridge.lcm_class(name)
            self.assertEqual([f.name for f in message.fields], list(generated.__slots__), name)
            constants = {key: value for key, value in vars(generated).items() if key.isupper()}
            self.assertEqual({key: int(value) for _, key, value, _ in message.constants}, constants, name)

    def test_names_are_allowed_in_ros_2(self):
        for name, message in TYPES.items():
            self.assertRegex(ros_messages.ros_name(name), r"^([A-Z][a-z0-9]*)+$")
            for f in message.fields:
                self.assertRegex(f.name, r"^(?!.*__)[a-z][a-z0-9_]*[a-z0-9]$")

    def test_a_package_of_definitions_is_written(self):
        out = pathlib.Path(FOLDER.name, "msg")
        subprocess.run([sys.executable, TREE / "clients/examples/ros/ros_messages.py", TREE / "lcmtypes", out], check=True)
        self.assertEqual({path.stem for path in out.iterdir()}, {ros_messages.ros_name(name) for name in TYPES})
        self.assertIn("float64[3] position_ned_m", (out / "VehicleState.msg").read_text())


class Page(unittest.TestCase):
    def test_the_page_names_every_field_and_topic(self):
        page = (TREE / "docs/interfaces.md").read_text()
        named = 0
        for chapter in re.split(r"^## ", page, flags=re.M)[1:]:
            common, *sections = re.split(r"^### ", chapter, flags=re.M)  # of all its types: utime, session, ...
            for section in sections:
                for name in re.findall(r"`(\w+_t)`", section.splitlines()[0]):
                    named += 1
                    for f in TYPES[name].fields:
                        self.assertRegex(common + section, rf"`{f.name}(\[\d\])?`", f"{name} in {section.splitlines()[0]}")
        self.assertGreaterEqual(named, 12)
        for family, topics in ros_mapping.STANDARD.items():
            for topic in topics:
                self.assertIn(f"`{topic}`", page)


def until(condition, seconds=20):
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.02)
    return condition()


class Live(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.processes = []
        cls.addClassCleanup(cls.end)
        cls.start("rosmaster", "--core")
        cls.bus = lcm.LCM()
        cls.heard = []
        cls.bus.subscribe("SEND.*|COMMAND.*|STATE.rov", lambda channel, data: cls.heard.append((channel, data)))
        until(cls.master_answers)
        rospy.init_node("test", anonymous=True, disable_signals=True)
        cls.start(sys.executable, TREE / "clients/examples/ros/ros_bridge.py", "--vehicle", "auv-1", "--moved", "rov=9")

    @classmethod
    def start(cls, *command):
        cls.processes.append(subprocess.Popen([str(word) for word in command], stdout=subprocess.DEVNULL))

    @classmethod
    def end(cls):
        for process in reversed(cls.processes):
            process.terminate()
            process.wait(20)

    @staticmethod
    def master_answers():
        try:
            return rospy.get_master().getPid()[0] == 1
        except OSError:
            return False

    def from_ros(self, topic, kind, publish):
        """The first message of a topic while `publish` repeats what leads to it."""
        came = []
        subscriber = rospy.Subscriber(topic, kind, came.append)
        self.assertTrue(until(lambda: publish() or came), topic)
        subscriber.unregister()
        return came[0]

    def listen(self):
        self.bus.handle_timeout(5)

    def test_a_state_is_odometry_and_a_clock_the_time(self):
        state = ros_bridge.lcm_class("vehicle_state_t")()
        state.utime, state.position_ned_m, state.orientation_wxyz = 1_500_000, [1.0, 2.0, 3.0], [1.0, 0.0, 0.0, 0.0]
        odometry = self.from_ros("/auv_1/odometry", Odometry, lambda: self.bus.publish("STATE.auv-1", state.encode()))
        self.assertEqual((odometry.header.stamp.to_sec(), odometry.header.frame_id, odometry.child_frame_id), (1.5, "map", "auv_1/base_link"))
        self.assertEqual((odometry.pose.pose.position.x, odometry.pose.pose.position.y), (2, 1))
        clock = ros_bridge.lcm_class("sim_clock_t")()
        clock.utime = 2_500_001
        self.assertEqual(self.from_ros("/clock", Clock, lambda: self.bus.publish("CLOCK", clock.encode())).clock.to_nsec(), 2_500_001_000)

    def test_sensors_are_standard_messages_and_the_whole(self):
        sensors = ros_bridge.lcm_class("vehicle_sensors_t")()
        sensors.altitude_status, sensors.altitude_m, sensors.shaft_rpm = sensors.ALTITUDE_MEASURED, 4.5, 600.0
        publish = lambda: self.bus.publish("SENSORS.auv-1", sensors.encode())  # noqa: E731
        self.assertEqual(self.from_ros("/auv_1/altitude", Range, publish).range, 4.5)
        self.assertEqual(self.from_ros("/auv_1/sensors", CLASSES["vehicle_sensors_t"], publish).shaft_rpm, 600)

    def test_packets_are_received_and_outcomes_are_those_of_all(self):
        packet = ros_bridge.lcm_class("modem_receive_t")()
        packet.payload, packet.payload_size, packet.source_id = b"\0hello\xff", 7, 3
        publish = lambda: self.bus.publish("RECEIVE.auv-1", packet.encode())  # noqa: E731
        self.assertEqual(self.from_ros("/auv_1/receive", CLASSES["modem_receive_t"], publish).payload, b"\0hello\xff")
        outcome = ros_bridge.lcm_class("packet_outcome_t")()
        outcome.outcome = outcome.COLLIDED
        publish = lambda: self.bus.publish("OUTCOME", outcome.encode())  # noqa: E731
        self.assertEqual(self.from_ros("/halocline/outcome", CLASSES["packet_outcome_t"], publish).outcome, 6)

    def test_a_packet_is_sent_until_its_receipt(self):
        publisher = rospy.Publisher("/auv_1/send", CLASSES["modem_send_t"], queue_size=10)
        self.assertTrue(until(lambda: publisher.get_num_connections() > 0))
        self.heard.clear()
        send = CLASSES["modem_send_t"]()
        send.utime, send.session, send.packet_sequence, send.source_id, send.payload = 7, 5, 3, 1, b"abc"
        publisher.publish(send)
        self.assertTrue(until(lambda: self.listen() or len(self.heard) >= 2))
        self.assertEqual({channel for channel, _ in self.heard}, {"SEND.auv-1"})
        self.assertEqual(len({data for _, data in self.heard}), 1)
        packet = ros_bridge.lcm_class("modem_send_t").decode(self.heard[0][1])
        self.assertEqual((packet.session, packet.packet_sequence, packet.payload, packet.payload_size), (5, 3, b"abc", 3))
        receipt = ros_bridge.lcm_class("modem_receipt_t")()
        receipt.send_session, receipt.packet_sequence = 5, 3
        self.from_ros("/auv_1/receipt", CLASSES["modem_receipt_t"], lambda: self.bus.publish("RECEIPT.auv-1", receipt.encode()))
        until(lambda: self.listen(), 0.2)
        self.heard.clear()
        until(lambda: self.listen(), 3 * ros_bridge.REPEAT_S)
        self.assertEqual(self.heard, [])

    def test_a_vehicle_that_ros_moves_has_a_state(self):
        publisher = rospy.Publisher("/rov/odometry", Odometry, queue_size=10)
        self.assertTrue(until(lambda: publisher.get_num_connections() > 0))
        self.heard.clear()
        odometry = Odometry()
        odometry.header.stamp = rospy.Time(3, 5000)
        odometry.pose.pose.position.x, odometry.pose.pose.orientation.w = 7.0, 1.0
        self.assertTrue(until(lambda: publisher.publish(odometry) or self.listen() or len(self.heard) >= 2))
        first, second = (ros_bridge.lcm_class("vehicle_state_t").decode(data) for _, data in self.heard[:2])
        self.assertEqual((first.utime, first.vehicle_id, list(first.position_ned_m)), (3_000_005, 9, [0, 7, 0]))
        self.assertEqual(second.sequence, first.sequence + 1)
        self.assertGreater(first.session, 0)

    def test_what_does_not_decode_is_left_out(self):
        self.bus.publish("STATE.auv-1", b"\1\2\3")
        self.test_a_state_is_odometry_and_a_clock_the_time()


if __name__ == "__main__":
    unittest.main(warnings="ignore")  # of rospy
