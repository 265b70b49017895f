#!/usr/bin/env python3
# nav drives ahead for 8 s; in the middle, from 3 s to 5 s, the joystick turns left on the spot
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist


class Drivers(Node):
    def __init__(self):
        super().__init__('two_drivers')
        self.nav = self.create_publisher(Twist, '/nav/cmd_vel', 10)
        self.joy = self.create_publisher(Twist, '/joystick/cmd_vel', 10)
        self.k = 0
        self.create_timer(0.1, self.tick)

    def tick(self):
        if not (self.nav.get_subscription_count() and self.joy.get_subscription_count()):
            return
        ahead, left = Twist(), Twist()
        ahead.linear.x = 0.3
        left.angular.z = 0.6
        if self.k < 80:
            self.nav.publish(ahead)
        if 30 <= self.k < 50:
            self.joy.publish(left)
        self.k += 1


rclpy.init()
rclpy.spin(Drivers())
