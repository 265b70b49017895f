import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy, DurabilityPolicy, HistoryPolicy
from sensor_msgs.msg import LaserScan
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import SetParametersResult, ParameterDescriptor, FloatingPointRange
import numpy as np


class KeepDistance(Node):
    """P controller on the distance to the wall ahead; set point is a dynamic parameter"""

    def __init__(self):
        super().__init__('keep_distance')
        desc = ParameterDescriptor(
            description='distance to the wall ahead',
            floating_point_range=[FloatingPointRange(from_value=0.5, to_value=6.0, step=0.0)])
        self.declare_parameter('target', 3.0, desc)
        self.target = self.get_parameter('target').value
        self.add_on_set_parameters_callback(self.on_params)
        qos = QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=1,
                         reliability=ReliabilityPolicy.BEST_EFFORT,
                         durability=DurabilityPolicy.VOLATILE)
        self.sub = self.create_subscription(LaserScan, 'scan', self.scan_cb, qos)
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.ok_count = 0

    def on_params(self, params):
        for p in params:
            if p.name == 'target':
                self.get_logger().info(f'new target {p.value}')
                self.target = p.value
                self.ok_count = 0
        return SetParametersResult(successful=True)

    def scan_cb(self, scan):
        angles = scan.angle_min + np.arange(len(scan.ranges)) * scan.angle_increment
        angles = np.mod(angles + np.pi, 2 * np.pi) - np.pi
        r = np.asarray(scan.ranges)
        mask = (np.abs(angles) < 0.1) & np.isfinite(r)
        cmd = Twist()
        if mask.any():
            d = np.median(r[mask] * np.cos(angles[mask]))
            err = float(d) - self.target
            cmd.linear.x = float(np.clip(0.8 * err, -0.4, 0.4))
            self.ok_count = self.ok_count + 1 if abs(err) < 0.15 else 0
            if self.ok_count == 5:
                self.get_logger().info(f'at {self.target} m')
        self.pub.publish(cmd)


def main():
    rclpy.init()
    node = KeepDistance()
    rclpy.spin(node)


if __name__ == '__main__':
    main()
