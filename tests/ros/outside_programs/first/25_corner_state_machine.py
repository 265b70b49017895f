#!/usr/bin/env python3
import math
import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String


class CornerFinder(Node):
    """Go to the wall ahead, turn left 90 deg, go to the next wall: that's a corner."""

    def __init__(self):
        super().__init__('corner_finder')
        self.group1 = MutuallyExclusiveCallbackGroup()
        self.group2 = MutuallyExclusiveCallbackGroup()
        self.group3 = ReentrantCallbackGroup()
        self.cmd_pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.state_pub = self.create_publisher(String, 'state', 10)
        self.create_subscription(LaserScan, 'scan', self.scan_callback, qos_profile_sensor_data,
                                 callback_group=self.group1)
        self.create_subscription(Odometry, 'odom', self.odom_callback, 10, callback_group=self.group2)
        self.create_timer(0.1, self.control, callback_group=self.group3)
        self.front = math.inf
        self.yaw = None
        self.goal_yaw = None
        self.got_scan = False
        self.state = 'GO'
        self.walls = 0

    def scan_callback(self, msg):
        inc = msg.angle_increment
        centre = int(round((0.0 - msg.angle_min) / inc))
        k = int(math.radians(8) / inc)
        values = [msg.ranges[j % len(msg.ranges)] for j in range(centre - k, centre + k + 1)]
        values = [v for v in values if msg.range_min <= v <= msg.range_max]
        self.front = min(values, default=msg.range_max)
        self.got_scan = True

    def odom_callback(self, msg):
        q = msg.pose.pose.orientation
        self.yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))

    def set_state(self, s):
        self.get_logger().info(f'{self.state} -> {s}')
        self.state = s
        self.state_pub.publish(String(data=s))

    def control(self):
        if not self.got_scan or self.yaw is None:
            return
        cmd = Twist()
        if self.state == 'GO':
            if self.front < 1.2:
                self.walls += 1
                if self.walls == 2:
                    self.set_state('CORNER')
                else:
                    self.goal_yaw = self.yaw + math.pi / 2
                    self.set_state('TURN')
            else:
                cmd.linear.x = 0.45
        elif self.state == 'TURN':
            e = self.goal_yaw - self.yaw
            e = math.atan2(math.sin(e), math.cos(e))
            if abs(e) < 0.04:
                self.set_state('GO')
            else:
                cmd.angular.z = max(-0.6, min(0.6, 1.5 * e))
        self.cmd_pub.publish(cmd)


def main(args=None):
    rclpy.init(args=args)
    node = CornerFinder()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        executor.shutdown()
        node.destroy_node()


if __name__ == '__main__':
    main()
