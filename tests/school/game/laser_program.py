"""A tidy laser program, as a student would write it after the lessons: to the target, along the freest beam that leads there.

It has the laser and the odometry, no map and no plan. ``tests/school/game/measured_drivers.py`` measures the medals by it.
"""

from __future__ import annotations

import math

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

SPEED, TURN_RATE = 0.5, 1.5
HALF_WIDTH = 0.14
"""Of the robot, and something to spare [m]."""
LOOK = 0.9
"""Farther obstacles do not matter [m]."""
NEAR = 0.2
"""A target that is so near has been reached [m]."""


class LaserProgram(Node):
    def __init__(self):
        super().__init__("laser_program")
        for name, value in (("target", [0.0, 0.0]), ("targets", [0.0])):
            self.declare_parameter(name, value)
        targets = list(self.get_parameter("targets").value)
        if len(targets) < 2:
            targets = list(self.get_parameter("target").value)
        self.targets = list(zip(targets[::2], targets[1::2], strict=True))
        self.pose = self.scan = self.first = None
        self.publisher = self.create_publisher(Twist, "cmd_vel", 1)
        self.create_subscription(Odometry, "odom", self.hear, 1)
        self.create_subscription(LaserScan, "static_laser", self.see, 1)
        self.create_timer(0.05, self.drive)

    def hear(self, message):
        place, turn = message.pose.pose.position, message.pose.pose.orientation
        self.pose = place.x, place.y, 2.0 * math.atan2(turn.z, turn.w)

    def see(self, message):
        self.scan = message

    def drive(self):
        if self.pose is None or self.scan is None or not self.targets:
            return
        x, y, theta = self.pose
        to_x, to_y = self.targets[0]
        distance = math.hypot(to_x - x, to_y - y)
        if distance < NEAR and len(self.targets) > 1:
            self.targets.pop(0)
            return
        wanted = math.remainder(math.atan2(to_y - y, to_x - x) - theta, math.tau)
        heading, free = self.freest(wanted, min(distance, LOOK))
        command = Twist()
        command.angular.z = max(-TURN_RATE, min(TURN_RATE, 4.0 * heading))
        slow = max(0.0, math.cos(1.3 * heading))
        command.linear.x = SPEED * slow * min(1.0, free / 0.3)
        self.publisher.publish(command)

    def freest(self, wanted, look):
        """The heading nearest to the wanted one in which the robot has room, and how much it has."""
        scan = self.scan
        points = []
        for number, distance in enumerate(scan.ranges):
            if scan.range_min <= distance <= scan.range_max and math.isfinite(distance):
                angle = scan.angle_min + number * scan.angle_increment
                points.append((distance * math.cos(angle), distance * math.sin(angle)))
        best, best_cost, best_room = wanted, math.inf, 0.0
        candidates = [math.radians(degrees) for degrees in range(-110, 111, 5)]
        if abs(wanted) <= math.radians(110):
            candidates.append(wanted)
        for heading in candidates:
            cosine, sine = math.cos(heading), math.sin(heading)
            room = look
            for x, y in points:
                along, across = x * cosine + y * sine, y * cosine - x * sine
                if along > 0.0 and abs(across) < HALF_WIDTH:
                    room = min(room, along)
            cost = abs(math.remainder(heading - wanted, math.tau)) + 0.2 * abs(heading) + 3.0 * (look - room)
            if cost < best_cost:
                best, best_cost, best_room = heading, cost, room
        return best, max(0.0, best_room - 0.1)


def main():
    rclpy.init()
    rclpy.spin(LaserProgram())


if __name__ == "__main__":
    main()
