"""A tidy program of a student who has read the level's map: it follows points, and does what the level's hint asks for.

``tests/school/game/map_plans.py`` reads the points off the map; ``tests/school/game/measured_drivers.py`` measures the medals by it.
"""

from __future__ import annotations

import math

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage

WAY = []
"""Points to each target in turn [m]."""
DOCKED = []
"""Numbers of the ways that end at a dock."""
WALLS = []
"""The ends of the walls [m], where the odometry is not to be trusted."""
HAS_CARTS = False
ACCELERATION = 0.0
"""Of the level [m/s^2]; 0: no ice."""
STEERING = 0.0
"""The largest angle of a tricycle's wheel [rad]; 0: it turns by its two wheels."""

SPEED, TURN_RATE, PAIR_TURN_RATE = 0.5, 1.5, 0.8
AHEAD, NEAR, FOLLOWED = 0.3, 0.2, 0.55
"""It aims at the point so far ahead on its way, takes one so near for reached, and keeps so far from a leader [m]."""
DOCK_TIME = 1.3
HALF_WIDTH, LOOK = 0.14, 0.6
"""Of the robot and something to spare, and how far it looks for carts [m]."""


class MapProgram(Node):
    def __init__(self):
        super().__init__("map_program")
        self.declare_parameter("models", ["robot"])
        self.declare_parameter("leader_frame", "")
        names = list(self.get_parameter("models").value)
        self.leader = self.get_parameter("leader_frame").value
        self.poses, self.odometry = {}, {}
        self.leader_place = self.seen = None
        self.leg = self.point = 0
        self.back = None
        self.docked = 0.0
        self.reversing = 0.0
        self.drives = {}
        for name in names:
            space = f"/{name}/" if len(names) > 1 else ""
            self.drives[name] = self.create_publisher(Twist, f"{space}cmd_vel", 1)
            self.create_subscription(
                Odometry, f"{space}odom", lambda message, name=name: self.hear(name, message), 1
            )
        if WALLS or HAS_CARTS or self.leader:
            self.create_subscription(LaserScan, "static_laser", self.see, 1)
        if self.leader:
            self.create_subscription(TFMessage, "/tf", self.watch, 10)
        self.create_timer(0.05, self.drive)

    def hear(self, name, message):
        """Adds what the wheels have measured since the last message to where the robot is."""
        place, turn = message.pose.pose.position, message.pose.pose.orientation
        new = place.x, place.y, 2.0 * math.atan2(turn.z, turn.w)
        if name not in self.poses or not WALLS:
            self.poses[name] = new
        else:
            x, y, theta = self.poses[name]
            old = self.odometry[name]
            dx, dy, across = new[0] - old[0], new[1] - old[1], theta - old[2]
            self.poses[name] = (
                x + math.cos(across) * dx - math.sin(across) * dy,
                y + math.sin(across) * dx + math.cos(across) * dy,
                theta + math.remainder(new[2] - old[2], math.tau),
            )
        self.odometry[name] = new

    def see(self, scan):
        ranges = np.asarray(scan.ranges)
        is_seen = (scan.range_min <= ranges) & (ranges <= scan.range_max)
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        self.seen = angles[is_seen], ranges[is_seen]
        if WALLS and self.poses:
            self.find_place(*self.seen)

    def find_place(self, angles, ranges):
        """Shifts and turns the pose so that the measured points lie on the nearest walls."""
        (name,) = self.poses
        x, y, theta = self.poses[name]
        walls = np.array(WALLS)
        starts, ways = walls[:, :2], walls[:, 2:] - walls[:, :2]
        for _ in range(3):
            beams = theta + angles
            points = np.column_stack((x + ranges * np.cos(beams), y + ranges * np.sin(beams)))
            to_points = points[:, None] - starts
            share = np.clip((to_points * ways).sum(-1) / (ways**2).sum(-1), 0.0, 1.0)
            away = to_points - share[..., None] * ways
            nearest = np.hypot(*away.transpose(2, 0, 1)).argmin(1)
            away = away[np.arange(len(points)), nearest]
            normals = np.column_stack((-ways[nearest, 1], ways[nearest, 0]))
            normals /= np.hypot(*normals.T)[:, None]
            misses = (away * normals).sum(1)
            arms = normals[:, 1] * (points[:, 0] - x) - normals[:, 0] * (points[:, 1] - y)
            slopes = np.column_stack((normals, arms))[np.hypot(*away.T) < 0.25]
            misses = misses[np.hypot(*away.T) < 0.25]
            if len(misses) < 20:
                return
            dx, dy, turn = np.linalg.solve(slopes.T @ slopes + 0.1 * np.eye(3), -slopes.T @ misses)
            x, y, theta = x + dx, y + dy, theta + turn
        self.poses[name] = float(x), float(y), float(theta)

    def watch(self, message):
        for each in message.transforms:
            if each.child_frame_id == self.leader:
                self.leader_place = each.transform.translation.x, each.transform.translation.y

    def drive(self):
        if len(self.poses) < len(self.drives) or (HAS_CARTS and self.seen is None):
            return
        x, y = (sum(pose[axis] for pose in self.poses.values()) / len(self.poses) for axis in (0, 1))
        theta = next(iter(self.poses.values()))[2]
        if self.leader:
            self.send(*self.follow(x, y, theta), (x, y, theta))
        elif self.leg < len(WAY):
            self.send(*self.along(x, y, theta), (x, y, theta))

    def send(self, speed, turn, middle):
        """Drives one robot, or two as if they were one: the outer one of a bend is quicker, who is behind catches up."""
        x, y, theta = middle
        for name, publisher in self.drives.items():
            pose = self.poses[name]
            command = Twist()
            command.linear.x, command.angular.z = float(speed), float(turn)
            if len(self.drives) > 1:
                dx, dy = pose[0] - x, pose[1] - y
                ahead = dx * math.cos(theta) + dy * math.sin(theta)
                beside = dy * math.cos(theta) - dx * math.sin(theta)
                command.linear.x = speed - turn * beside - 1.5 * ahead
                command.angular.z += 1.5 * math.remainder(theta - pose[2], math.tau)
            publisher.publish(command)

    def follow(self, x, y, theta):
        if self.leader_place is None or self.seen is None:
            return 0.0, 0.0
        to_x, to_y = self.leader_place
        error = math.remainder(math.atan2(to_y - y, to_x - x) - theta, math.tau)
        gap = math.hypot(to_x - x, to_y - y) - FOLLOWED
        if gap > LOOK:
            return self.past_carts(error)
        speed = max(-SPEED, min(SPEED, 3.0 * gap)) * max(0.0, math.cos(error))
        return speed, max(-TURN_RATE, min(TURN_RATE, 4.0 * error))

    def along(self, x, y, theta):
        """The speed and turn rate, or a tricycle's angle, that lead along the way."""
        way = WAY[self.leg]
        self.point = min(
            range(self.point, min(self.point + 12, len(way))), key=lambda each: math.dist(way[each], (x, y))
        )
        if self.point > len(way) - 10 and math.dist(way[-1], (x, y)) < NEAR:
            return self.arrive()
        aim = self.point
        while aim < len(way) - 1 and math.dist(way[aim], (x, y)) < AHEAD:
            aim += 1
        error = math.remainder(math.atan2(way[aim][1] - y, way[aim][0] - x) - theta, math.tau)
        if STEERING:
            return self.by_wheel(error)
        if self.back is None:
            self.back = abs(error) > 2.0
        if self.back:
            error = math.remainder(error + math.pi, math.tau)
        if HAS_CARTS and not self.back:
            return self.past_carts(error)
        speed, turn = self.on_ice(error, aim) if ACCELERATION else self.on_floor(error)
        return (-speed if self.back else speed), turn

    def arrive(self):
        if self.leg in DOCKED and self.docked < DOCK_TIME:
            self.docked += 0.05
        else:
            self.leg, self.point, self.back, self.docked = self.leg + 1, 0, None, 0.0
        return 0.0, 0.0

    def on_floor(self, error):
        rate = TURN_RATE if len(self.drives) == 1 else PAIR_TURN_RATE
        return SPEED * max(0.0, math.cos(1.3 * error)), max(-rate, min(rate, 4.0 * error))

    def on_ice(self, error, aim):
        """As fast as it can still brake before the next bend, turning as far as it can still stop turning."""
        way = WAY[self.leg]
        towards = math.atan2(way[aim][1] - way[self.point][1], way[aim][0] - way[self.point][0])
        length, allowed = 0.0, SPEED
        for number in range(self.point, len(way) - 6):
            length += math.dist(way[number], way[number + 1])
            bend = math.atan2(way[number + 6][1] - way[number][1], way[number + 6][0] - way[number][0])
            off = abs(math.remainder(bend - towards, math.tau))
            slow = SPEED * max(0.25, 1.0 - 0.8 * off)
            allowed = min(allowed, math.sqrt(slow**2 + 2.0 * 0.7 * ACCELERATION * length))
        rate = math.copysign(math.sqrt(2.0 * 0.6 * 3.0 * ACCELERATION * abs(error)), error)
        return allowed * max(0.0, math.cos(1.3 * error)), max(-TURN_RATE, min(TURN_RATE, rate))

    def by_wheel(self, error):
        """Backs off, with the wheel the other way round, from what it cannot steer to."""
        if abs(error) > 1.4:
            self.reversing = math.copysign(1.0, error)
        elif abs(error) < 0.5:
            self.reversing = 0.0
        if self.reversing:
            return -SPEED, -self.reversing * STEERING
        return SPEED, max(-STEERING, min(STEERING, 1.5 * error))

    def past_carts(self, error):
        """Where it wants to go, or the heading next to it in which the robot has room."""
        angles, ranges = self.seen
        x, y = ranges * np.cos(angles), ranges * np.sin(angles)
        headings = np.append(np.radians(np.arange(-110.0, 111.0, 5.0)), error)
        cosine, sine = np.cos(headings)[:, None], np.sin(headings)[:, None]
        along, across = x * cosine + y * sine, y * cosine - x * sine
        is_in_the_way = (along > 0.0) & (np.abs(across) < HALF_WIDTH)
        room = np.min(np.where(is_in_the_way, along, LOOK), axis=1, initial=LOOK)
        best = np.argmin(np.abs(headings - error) + 0.2 * np.abs(headings) + 3.0 * (LOOK - room))
        speed, turn = self.on_floor(headings[best])
        return speed * min(1.0, max(0.0, room[best] - 0.1) / 0.3), turn


def main():
    rclpy.init()
    rclpy.spin(MapProgram())


if __name__ == "__main__":
    main()
