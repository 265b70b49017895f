#!/usr/bin/env python3
import rclpy
from rclpy.node import Node

from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from math import sqrt, pow, atan2, pi


def quaternion_to_euler(orientation):
    x, y, z, w = orientation.x, orientation.y, orientation.z, orientation.w
    return atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


class Square(Node):

    def __init__(self):
        super().__init__("move_square")
        self.first_message = False
        self.turn = False
        self.vel_msg = Twist()
        self.x = self.y = self.theta_z = 0.0
        self.xref = self.yref = 0.0
        self.yaw_turned = 0.0
        self.corner = 0
        self.vel_pub = self.create_publisher(Twist, "cmd_vel", 10)
        self.odom_sub = self.create_subscription(Odometry, "odom", self.odom_callback, 10)
        self.timer = self.create_timer(0.05, self.timer_callback)

    def odom_callback(self, msg_data):
        pose = msg_data.pose.pose
        theta = quaternion_to_euler(pose.orientation)
        if not self.first_message:
            self.first_message = True
            self.xref, self.yref = pose.position.x, pose.position.y
        elif self.turn:
            d = theta - self.theta_z
            if d > pi:
                d -= 2 * pi
            elif d < -pi:
                d += 2 * pi
            self.yaw_turned += d
        self.x, self.y, self.theta_z = pose.position.x, pose.position.y, theta

    def timer_callback(self):
        if not self.first_message:
            return
        self.vel_msg = Twist()
        if self.corner == 4:
            self.get_logger().info("back home", once=True)
        elif self.turn:
            left = pi / 2 - self.yaw_turned
            if left < 0.02:
                self.turn = False
                self.corner += 1
                self.get_logger().info(f"corner {self.corner} done")
                self.xref, self.yref = self.x, self.y
            else:
                self.vel_msg.angular.z = min(0.5, max(0.08, 1.5 * left))
        else:
            if sqrt(pow(self.x - self.xref, 2) + pow(self.y - self.yref, 2)) > 1.0:
                self.turn = True
                self.yaw_turned = 0.0
            else:
                self.vel_msg.linear.x = 0.25
        self.vel_pub.publish(self.vel_msg)


def main(args=None):
    rclpy.init(args=args)
    move_square = Square()
    try:
        rclpy.spin(move_square)
    except KeyboardInterrupt:
        pass
    finally:
        move_square.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
