"""Follows the wall at its right hand: the two-beam rule of the racing courses, with a state for corners."""

import math
from enum import Enum

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan


class State(Enum):
    SEARCH = 0
    CORNER = 1
    FOLLOW = 2


class RightHand(Node):
    def __init__(self):
        super().__init__("right_hand")
        self.declare_parameter("distance", 0.8)
        self.declare_parameter("speed", 0.5)
        self.pub = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_subscription(LaserScan, "/scan", self.on_scan, qos_profile_sensor_data)
        self.create_subscription(Odometry, "/odom", self.on_odom, 10)
        self.state = State.SEARCH
        self.corners = 0
        self.far = 0.0

    def on_odom(self, odom):
        self.far = max(self.far, abs(odom.pose.pose.position.x), abs(odom.pose.pose.position.y))

    def beam(self, scan, degrees):
        angle = math.radians(degrees)
        while angle < scan.angle_min:
            angle += 2 * math.pi
        index = round((angle - scan.angle_min) / scan.angle_increment)
        value = scan.ranges[min(index, len(scan.ranges) - 1)]
        return value if math.isfinite(value) else scan.range_max

    def on_scan(self, scan):
        wanted = self.get_parameter("distance").value
        speed = self.get_parameter("speed").get_parameter_value().double_value
        front = float(np.min([self.beam(scan, degrees) for degrees in range(-15, 16, 3)]))
        command = Twist()
        if self.state == State.SEARCH:
            command.linear.x = speed
            if front < wanted + 0.2:
                self.change(State.CORNER)
        elif self.state == State.CORNER:
            command.angular.z = 0.8
            side, ahead = self.beam(scan, -90), self.beam(scan, -50)
            theta = math.radians(40)
            alpha = math.atan2(ahead * math.cos(theta) - side, ahead * math.sin(theta))
            if front > 2.0 and abs(alpha) < 0.12:
                self.corners += 1
                self.change(State.FOLLOW)
        else:
            side, ahead = self.beam(scan, -90), self.beam(scan, -50)
            theta = math.radians(40)
            alpha = math.atan2(ahead * math.cos(theta) - side, ahead * math.sin(theta))
            distance = side * math.cos(alpha) + 0.4 * math.sin(alpha)
            command.linear.x = speed
            command.angular.z = float(np.clip(1.5 * (wanted - distance), -0.8, 0.8))
            if front < wanted + 0.2:
                self.change(State.CORNER)
        self.pub.publish(command)

    def change(self, state):
        self.get_logger().info(f"{self.state.name} -> {state.name} corners {self.corners} far {self.far:.1f}")
        self.state = state


def main(args=None):
    rclpy.init(args=args)
    node = RightHand()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
