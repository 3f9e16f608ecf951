# SPDX-License-Identifier: BSD-3-Clause
"""Halocline's messages as the standard messages of ROS, and back: pure functions, the same for ROS 1 and 2 (docs/interfaces.md).

ROS has the world east, north, up (ENU, frame `map`) and bodies forward, left, up (FLU, frame `VEHICLE/base_link`): REP 103, 105.
Halocline has north, east, down and forward, starboard, down. With

        | 0 1  0 |        | 1  0  0 |
    E = | 1 0  0 |,   F = | 0 -1  0 |    v_enu = E v_ned, v_flu = F v_body, R(body to ENU) = E R(body to NED) F
        | 0 0 -1 |        | 0  0 -1 |

and for the unit quaternion (w, x, y, z) of the body in NED that in ENU is (w + z, x + y, x - y, w - z) / sqrt 2. All three are their own
inverses. Functions take a message of LCM and return a message of ROS without its header.stamp; None where nothing was measured.
"""
import math

from geometry_msgs.msg import PointStamped, PoseWithCovarianceStamped, TwistStamped, TwistWithCovarianceStamped, Vector3Stamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import BatteryState, Imu, LaserScan, Range

WORLD = "map"
NOT_MEASURED = -1.0  # in the first element of a covariance


def world(v):
    """ENU of NED, and back."""
    return v[1], v[0], -v[2]


def body(v):
    """FLU of the body's axes, and back."""
    return v[0], -v[1], -v[2]


def turned(q):
    """(w, x, y, z) of the body in ENU of that in NED, and back."""
    w, x, y, z = (element * math.sqrt(0.5) for element in q)
    return w + z, x + y, x - y, w - z


def rotation(q):
    """The matrix of a unit quaternion, row by row."""
    w, x, y, z = q
    return ((1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)))


def quaternion(heading, pitch, roll):
    """(w, x, y, z) of the body in NED: heading about down, then pitch about starboard, then roll about forward."""
    (ch, sh), (cp, sp), (cr, sr) = ((math.cos(a / 2), math.sin(a / 2)) for a in (heading, pitch, roll))
    return (ch * cp * cr + sh * sp * sr, ch * cp * sr - sh * sp * cr, ch * sp * cr + sh * cp * sr, sh * cp * cr - ch * sp * sr)


def put(place, values, names="xyz"):
    for name, value in zip(names, values):
        setattr(place, name, value)


def odometry(state, vehicle):
    """STATE. The twist is in the body's frame, as nav_msgs has it."""
    out = Odometry()
    out.header.frame_id, out.child_frame_id = WORLD, f"{vehicle}/base_link"
    put(out.pose.pose.position, world(state.position_ned_m))
    put(out.pose.pose.orientation, turned(state.orientation_wxyz), "wxyz")
    columns = zip(*rotation(state.orientation_wxyz))
    put(out.twist.twist.linear, body([sum(a * b for a, b in zip(c, state.velocity_ned_mps)) for c in columns]))
    put(out.twist.twist.angular, body(state.angular_velocity_body_radps))
    return out


def set_state(state, odometry):
    """The same back, for a vehicle that ROS moves."""
    pose, twist = odometry.pose.pose, odometry.twist.twist
    state.position_ned_m = list(world((pose.position.x, pose.position.y, pose.position.z)))
    q = turned((pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z))
    norm = math.sqrt(sum(element * element for element in q))
    state.orientation_wxyz = [element / norm for element in q]
    velocity = body((twist.linear.x, twist.linear.y, twist.linear.z))
    state.velocity_ned_mps = [sum(a * b for a, b in zip(row, velocity)) for row in rotation(state.orientation_wxyz)]
    state.angular_velocity_body_radps = list(body((twist.angular.x, twist.angular.y, twist.angular.z)))


def imu(sensors, vehicle):
    """SENSORS: attitude and rates. An accelerometer is not simulated."""
    if not (sensors.attitude_fresh or sensors.angular_rate_fresh):
        return None
    out = Imu()
    out.header.frame_id = f"{vehicle}/base_link"
    out.linear_acceleration_covariance = [NOT_MEASURED] + 8 * [0.0]
    if sensors.attitude_fresh:
        put(out.orientation, turned(quaternion(sensors.heading_rad, sensors.pitch_rad, sensors.roll_rad)), "wxyz")
    else:
        out.orientation_covariance = [NOT_MEASURED] + 8 * [0.0]
    if sensors.angular_rate_fresh:
        put(out.angular_velocity, body(sensors.angular_rate_body_radps))
    else:
        out.angular_velocity_covariance = [NOT_MEASURED] + 8 * [0.0]
    return out


def depth(sensors, vehicle):
    """SENSORS: z is up from the sea surface, so negative."""
    if not sensors.depth_fresh:
        return None
    out = PointStamped()
    out.header.frame_id = f"{vehicle}/sea_surface"
    out.point.z = -sensors.depth_m
    return out


def altitude(sensors, vehicle):
    """SENSORS: an echo sounder that looks down; +Inf where it sees no bottom (REP 117)."""
    if sensors.altitude_status == sensors.ALTITUDE_UNAVAILABLE:
        return None
    out = Range()
    out.header.frame_id = f"{vehicle}/altimeter"
    out.radiation_type = Range.ULTRASOUND
    out.max_range = math.inf
    out.range = sensors.altitude_m if sensors.altitude_status == sensors.ALTITUDE_MEASURED else math.inf
    return out


def water_speed(sensors, vehicle):
    """SENSORS: through the water, forward."""
    if not sensors.water_speed_fresh:
        return None
    out = TwistStamped()
    out.header.frame_id = f"{vehicle}/base_link"
    out.twist.linear.x = sensors.water_speed_mps
    return out


def dvl(dvl, vehicle):
    """DVL: velocity over ground; its covariance depends on the beams and is left at 0, unknown."""
    if not dvl.ground_velocity_valid:
        return None
    out = TwistWithCovarianceStamped()
    out.header.frame_id = f"{vehicle}/base_link"
    put(out.twist.twist.linear, body(dvl.ground_velocity_body_mps))
    return out


def gps(gps, vehicle):
    """GPS: the fix in the world frame; neither depth nor attitude, whose variances are great."""
    out = PoseWithCovarianceStamped()
    out.header.frame_id = WORLD
    out.pose.pose.position.x, out.pose.pose.position.y = gps.fix_east_m, gps.fix_north_m
    out.pose.pose.orientation.w = 1.0
    variance = gps.fix_deviation_m ** 2
    out.pose.covariance = [variance if i in (0, 7) else 1e12 if i % 7 == 0 else 0.0 for i in range(36)]
    return out


def estimate(estimate, vehicle):
    """ESTIMATE: a position with its covariance, E C E'."""
    if estimate.estimate_status == estimate.NONE:
        return None
    out = PoseWithCovarianceStamped()
    out.header.frame_id = WORLD
    put(out.pose.pose.position, world(estimate.position_ned_m))
    out.pose.pose.orientation.w = 1.0
    covariance = [1e12 if i % 7 == 0 and i > 14 else 0.0 for i in range(36)]
    place, sign = (1, 0, 2), (1, 1, -1)  # of E's rows
    for i in range(3):
        for j in range(3):
            covariance[6 * i + j] = sign[i] * sign[j] * estimate.covariance_ned_m2[3 * place[i] + place[j]]
    out.pose.covariance = covariance
    return out


def sonar(sonar, vehicle):
    """SONAR: a scan, whose angles rise to port; None unless they are equally spaced. The frame is tilted by fan_tilt_rad."""
    angles = [-azimuth for azimuth in sonar.fan_azimuth_rad]
    order = sorted(range(len(angles)), key=angles.__getitem__)
    step = (angles[order[-1]] - angles[order[0]]) / max(1, len(order) - 1)
    if any(abs(angles[i] - angles[order[0]] - n * step) > 1e-6 for n, i in enumerate(order)):
        return None
    out = LaserScan()
    out.header.frame_id = f"{vehicle}/sonar"
    out.angle_min, out.angle_max, out.angle_increment = angles[order[0]], angles[order[-1]], step
    out.range_max = sonar.max_range_m
    found = {sonar.ECHO_NONE: math.inf, sonar.ECHO_UNAVAILABLE: math.nan}  # REP 117
    out.ranges = [found.get(sonar.echo_status[i], sonar.echo_range_m[i]) for i in order]
    return out


def usbl(usbl, vehicle):
    """USBL: the direction to the sender, of length 1."""
    out = Vector3Stamped()
    out.header.frame_id = f"{vehicle}/usbl"
    level = math.cos(usbl.peer_elevation_rad)
    forward, starboard = level * math.cos(usbl.peer_bearing_rad), level * math.sin(usbl.peer_bearing_rad)
    put(out.vector, body((forward, starboard, -math.sin(usbl.peer_elevation_rad))))
    return out


def battery(battery, vehicle):
    """BATTERY: energy as a part of what it holds when full; ROS counts charge, which is not simulated."""
    out = BatteryState()
    out.header.frame_id = f"{vehicle}/base_link"
    out.voltage = out.current = out.charge = out.capacity = out.design_capacity = out.temperature = math.nan
    out.percentage = max(0.0, battery.energy_left_j / battery.capacity_j) if battery.capacity_j > 0 else math.nan
    out.power_supply_status = BatteryState.POWER_SUPPLY_STATUS_DISCHARGING
    out.present = True
    return out


# What is made of each family of channels, by the topic in the vehicle's name space.
STANDARD = {
    "STATE": {"odometry": odometry},
    "SENSORS": {"imu": imu, "depth": depth, "altitude": altitude, "water_speed": water_speed},
    "DVL": {"ground_velocity": dvl},
    "GPS": {"fix": gps},
    "SONAR": {"scan": sonar},
    "USBL": {"direction": usbl},
    "BATTERY": {"battery_state": battery},
    "ESTIMATE": {"pose": estimate},
}
