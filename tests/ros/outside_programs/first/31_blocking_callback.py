#!/usr/bin/env python3
# The way we did it in the first week: everything in ONE timer callback, with sleeps. (Don't do this!)
import datetime
import time as t

import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist


class Blocking(Node):
    def __init__(self):
        super().__init__('blocking')
        self.p = self.create_publisher(Twist, 'cmd_vel', 10)
        self.timer = self.create_timer(1, self.callback)
        self.runs = 0

    def move(self, linear, angular, seconds):
        end = datetime.datetime.now() + datetime.timedelta(seconds=seconds)
        msg = Twist()
        msg.linear.x = float(linear)
        msg.angular.z = float(angular)
        while datetime.datetime.now() < end:
            self.p.publish(msg)
            t.sleep(0.1)

    def callback(self):
        self.runs += 1
        self.get_logger().info(f'run {self.runs}')
        self.move(0.25, 0, 2)
        self.move(0, 0.5, 2)
        self.move(0, 0, 0.5)
        if self.runs == 3:
            self.get_logger().info('three runs are enough')
            self.timer.cancel()


rclpy.init()
blocking = Blocking()
while rclpy.ok() and not blocking.timer.is_canceled():
    rclpy.spin_once(blocking)
blocking.destroy_node()
rclpy.shutdown()
