import math

import rclpy
from geometry_msgs.msg import Vector3Stamped
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import Imu
from tf_transformations import euler_from_quaternion, quaternion_from_euler


class ComplementaryFilter(Node):
    def __init__(self):
        super().__init__("complementary_filter")
        self.alpha = self.declare_parameter("alpha", 0.98).value
        self.roll = self.pitch = 0.0
        self.previous = None
        self.pub = self.create_publisher(Vector3Stamped, "rpy", 10)
        self.filtered = self.create_publisher(Imu, "imu/data", 10)
        self.create_subscription(Imu, "imu/data_raw", self.update, 50)

    def update(self, msg):
        now = Time.from_msg(msg.header.stamp)
        a, w = msg.linear_acceleration, msg.angular_velocity
        acc_roll = math.atan2(a.y, a.z)
        acc_pitch = math.atan2(-a.x, math.hypot(a.y, a.z))
        if self.previous is not None:
            dt = (now - self.previous).nanoseconds / 1e9
            self.roll = self.alpha * (self.roll + w.x * dt) + (1 - self.alpha) * acc_roll
            self.pitch = self.alpha * (self.pitch + w.y * dt) + (1 - self.alpha) * acc_pitch
        self.previous = now
        out = Vector3Stamped(header=msg.header)
        out.vector.x, out.vector.y = self.roll, self.pitch
        self.pub.publish(out)
        q = quaternion_from_euler(self.roll, self.pitch, 0.0)
        msg.orientation.x, msg.orientation.y, msg.orientation.z, msg.orientation.w = q
        msg.orientation_covariance[0] = 0.01
        self.filtered.publish(msg)
        r, p, _ = euler_from_quaternion([msg.orientation.x, msg.orientation.y, msg.orientation.z, msg.orientation.w])
        self.get_logger().info(
            f"roll {math.degrees(r):.0f} pitch {math.degrees(p):.0f}", throttle_duration_sec=2.0)


def main():
    rclpy.init()
    rclpy.spin(ComplementaryFilter())


if __name__ == "__main__":
    main()
