#!/usr/bin/env python3
import math
import numpy as np
import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan
from std_srvs.srv import Trigger


class FaceNearest(Node):
    """/leave_centre drives 1.5 m ahead, /face_away turns until the nearest wall is behind the robot.
    The service callbacks block with a Rate while the other callbacks go on (reentrant group)."""

    def __init__(self):
        super().__init__('face_nearest')
        g = ReentrantCallbackGroup()
        self.bearing = None
        self.x = None
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, qos_profile_sensor_data, callback_group=g)
        self.create_subscription(Odometry, 'odom', self.on_odom, 10, callback_group=g)
        self.create_service(Trigger, 'leave_centre', self.leave, callback_group=g)
        self.create_service(Trigger, 'face_away', self.face, callback_group=g)
        self.rate = self.create_rate(10)

    def on_scan(self, msg):
        r = np.array(msg.ranges, dtype=float)
        r[~np.isfinite(r)] = np.inf
        k = int(np.argmin(r))
        a = msg.angle_min + k * msg.angle_increment
        self.bearing = math.atan2(math.sin(a), math.cos(a))

    def on_odom(self, msg):
        self.x = msg.pose.pose.position.x

    def leave(self, request, response):
        while self.x is None:
            self.rate.sleep()
        x0 = self.x
        t = Twist()
        t.linear.x = 0.3
        while abs(self.x - x0) < 1.5:
            self.pub.publish(t)
            self.rate.sleep()
        self.pub.publish(Twist())
        response.success, response.message = True, f'now {self.x - x0:.1f} m off'
        return response

    def face(self, request, response):
        while True:
            if self.bearing is not None:
                err = math.remainder(self.bearing - math.pi, 2 * math.pi)
                if abs(err) < 0.08:
                    break
                t = Twist()
                t.angular.z = math.copysign(max(0.1, min(0.7, abs(err))), err)
                self.pub.publish(t)
            self.rate.sleep()
        self.pub.publish(Twist())
        response.success = True
        response.message = 'nearest wall is behind'
        return response


def main(args=None):
    rclpy.init(args=args)
    node = FaceNearest()
    ex = MultiThreadedExecutor(num_threads=4)
    ex.add_node(node)
    try:
        ex.spin()
    except KeyboardInterrupt:
        pass


if __name__ == '__main__':
    main()
