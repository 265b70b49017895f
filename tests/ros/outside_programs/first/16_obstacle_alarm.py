#!/usr/bin/env python3
import rclpy
import numpy as np
from rclpy.node import Node
from rclpy.qos import QoSProfile, QoSReliabilityPolicy
from std_msgs.msg import Bool, Float32
from geometry_msgs.msg import Twist
from sensor_msgs.msg import LaserScan

class Alarm(Node):
    def __init__(self):
        super().__init__('alarm')
        best_effort = QoSProfile(depth=5, reliability=QoSReliabilityPolicy.BEST_EFFORT)
        self.create_subscription(LaserScan, '/scan', self.scan_cb, best_effort)
        self.pub_alarm = self.create_publisher(Bool, '/obstacle', 10)
        self.pub_nearest = self.create_publisher(Float32, '/nearest', 10)
        self.pub_vel = self.create_publisher(Twist, '/cmd_vel', 10)
        self.alarm = False

    def scan_cb(self, scan):
        r = np.array(scan.ranges)
        r[~np.isfinite(r)] = scan.range_max
        r[r < scan.range_min] = scan.range_max
        nearest = float(np.min(r))
        self.pub_nearest.publish(Float32(data=nearest))
        if nearest < 1.5 and not self.alarm:
            self.alarm = True
            self.get_logger().error('ALARM: something at %.1f m' % nearest)
        elif nearest > 2.0 and self.alarm:
            self.alarm = False
            self.get_logger().info('all clear')
        self.pub_alarm.publish(Bool(data=self.alarm))
        # creep backwards towards the rear wall until there is an alarm, then flee forwards
        cmd = Twist()
        cmd.linear.x = 0.35 if self.alarm else -0.35
        self.pub_vel.publish(cmd)

rclpy.init()
rclpy.spin(Alarm())
