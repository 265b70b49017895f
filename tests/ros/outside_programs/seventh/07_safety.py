"""A blind driver and a safety node between it and the wheels (automatic emergency braking by time to collision)."""
import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool


class Blind(Node):
    def __init__(self):
        super().__init__('blind_driver')
        self.pub = self.create_publisher(Twist, 'cmd_vel_raw', 10)
        self.create_timer(0.1, self.tick)

    def tick(self):
        t = Twist()
        t.linear.x = 0.2
        self.pub.publish(t)


class Safety(Node):
    def __init__(self):
        super().__init__('safety_node')
        self.ttc_limit = self.declare_parameter('ttc', 2.0).value
        self.v = 0.0
        self.braking = False
        self.out = self.create_publisher(Twist, 'cmd_vel', 10)
        self.flag = self.create_publisher(Bool, 'emergency_brake', 10)
        self.create_subscription(Odometry, 'odom', self.on_odom, 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, qos_profile_sensor_data)
        self.create_subscription(Twist, 'cmd_vel_raw', self.on_command, 10)

    def on_odom(self, msg):
        self.v = msg.twist.twist.linear.x

    def on_scan(self, scan):
        ranges = np.asarray(scan.ranges)
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        closing = self.v * np.cos(angles)
        usable = np.isfinite(ranges) & (ranges > scan.range_min) & (np.cos(angles) > 0.9)
        with np.errstate(divide='ignore'):
            ttc = np.where(usable & (closing > 1e-3), ranges / np.maximum(closing, 1e-9), np.inf)
        if not self.braking and ttc.min() < self.ttc_limit:
            self.braking = True
            self.get_logger().warning(f'braking: {ttc.min():.2f} s to collision, nearest {ranges[usable].min():.2f} m')
            self.flag.publish(Bool(data=True))
            self.out.publish(Twist())

    def on_command(self, msg):
        self.out.publish(Twist() if self.braking else msg)


def main():
    rclpy.init()
    executor = SingleThreadedExecutor()
    nodes = [Blind(), Safety()]
    for node in nodes:
        executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass
    finally:
        for node in nodes:
            node.destroy_node()
        executor.shutdown()


if __name__ == '__main__':
    main()
