"""Drive ahead at 0.15 m/s until something is nearer than 0.5 m in front, then turn on the spot; counts turns."""
import math
import numpy as np
import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, QoSReliabilityPolicy, QoSHistoryPolicy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import LaserScan


class Avoid(Node):
    def __init__(self):
        super().__init__("obstacle_stop")
        qos = QoSProfile(reliability=QoSReliabilityPolicy.BEST_EFFORT, history=QoSHistoryPolicy.KEEP_LAST, depth=1)
        self.create_subscription(LaserScan, "scan", self.on_scan, qos)
        self.cmd_pub = self.create_publisher(Twist, "cmd_vel", 10)
        self.turning = False
        self.turns = 0

    def on_scan(self, scan: LaserScan):
        angles = scan.angle_min + np.arange(len(scan.ranges)) * scan.angle_increment
        angles = np.arctan2(np.sin(angles), np.cos(angles))
        ranges = np.nan_to_num(np.asarray(scan.ranges), posinf=scan.range_max)
        ranges[ranges < scan.range_min] = scan.range_max
        ahead = ranges[np.abs(angles) < math.radians(30)].min()
        twist = Twist()
        if ahead < (0.7 if self.turning else 0.5):
            if not self.turning:
                self.turning = True
                self.turns += 1
                self.get_logger().warn(f"obstacle at {ahead:.2f} m, turn {self.turns}")
            twist.angular.z = 0.8
        else:
            self.turning = False
            twist.linear.x = 0.15
        self.cmd_pub.publish(twist)


def main(args=None):
    rclpy.init(args=args)
    try:
        node = Avoid()
        rclpy.spin(node)
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass
    finally:
        node.cmd_pub.publish(Twist())
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
