#!/usr/bin/env python3
from math import degrees, pi

import rclpy
from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from tf_transformations import euler_from_quaternion


class Figure8(Node):
    def __init__(self):
        super().__init__('figure8')
        self.first_message = False
        self.turn = True
        self.shutdown = False
        self.vel_msg = TwistStamped()
        self.x = self.y = self.theta_z = 0.0
        self.xref = self.yref = self.theta_zref = self.yaw = 0.0
        self.direction = 1
        self.loops = 0
        self.vel_pub = self.create_publisher(msg_type=TwistStamped, topic='cmd_vel', qos_profile=10)
        self.odom_sub = self.create_subscription(msg_type=Odometry, topic='odom', callback=self.odom_callback, qos_profile=10)
        self.timer = self.create_timer(timer_period_sec=0.05, callback=self.timer_callback)
        self.get_logger().info(f"The '{self.get_name()}' node is initialised.")

    def odom_callback(self, msg_data: Odometry):
        pose = msg_data.pose.pose
        (roll, pitch, yaw) = euler_from_quaternion([pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w])
        self.x, self.y, self.theta_z = pose.position.x, pose.position.y, yaw
        if not self.first_message:
            self.first_message = True
            self.xref, self.yref, self.theta_zref = self.x, self.y, yaw

    def timer_callback(self):
        if not self.first_message:
            return
        self.yaw += abs((self.theta_z - self.theta_zref + pi) % (2 * pi) - pi)
        self.theta_zref = self.theta_z
        if self.yaw >= 2 * pi:
            self.yaw = 0.0
            self.direction *= -1
            self.loops += 1
            self.get_logger().info(f'loop {self.loops} done, {((self.x - self.xref) ** 2 + (self.y - self.yref) ** 2) ** 0.5:.1f} m from the start')
            if self.loops == 2:
                self.shutdown = True
                return
        self.vel_msg = TwistStamped()
        self.vel_msg.header.stamp = self.get_clock().now().to_msg()
        self.vel_msg.twist.linear.x = 0.15
        self.vel_msg.twist.angular.z = self.direction * 0.6
        self.vel_pub.publish(self.vel_msg)
        self.get_logger().info(f'x={self.x:.2f} [m], y={self.y:.2f} [m], yaw={degrees(self.theta_z):.1f} [degrees].', throttle_duration_sec=1)

    def on_shutdown(self):
        for _ in range(5):
            self.vel_pub.publish(TwistStamped())
        self.shutdown = True
        self.get_logger().info('Stopping the robot')


def main(args=None):
    rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    node = Figure8()
    try:
        while not node.shutdown:
            rclpy.spin_once(node)
    except KeyboardInterrupt:
        print(f'{node.get_name()} received a shutdown request (Ctrl+C)')
    finally:
        node.on_shutdown()
        while not node.shutdown:
            continue
        node.destroy_node()
        rclpy.shutdown()


if __name__ == '__main__':
    main()
