"""An IMU that lies tilted: roll 20 degrees, pitch -10 degrees; 100 Hz with noise and gyro bias."""
import math
import random

import rclpy
from rclpy.node import Node
from sensor_msgs.msg import Imu


class FakeImu(Node):
    def __init__(self):
        super().__init__("fake_imu")
        self.pub = self.create_publisher(Imu, "imu/data_raw", 50)
        self.rng = random.Random(4)
        self.create_timer(0.01, self.tick)

    def tick(self):
        roll, pitch, g = math.radians(20), math.radians(-10), 9.81
        msg = Imu()
        msg.header.stamp = self.get_clock().now().to_msg()
        msg.header.frame_id = "imu_link"
        noise = lambda: self.rng.gauss(0, 0.3)
        msg.linear_acceleration.x = -g * math.sin(pitch) + noise()
        msg.linear_acceleration.y = g * math.sin(roll) * math.cos(pitch) + noise()
        msg.linear_acceleration.z = g * math.cos(roll) * math.cos(pitch) + noise()
        msg.angular_velocity.x = 0.002
        msg.orientation_covariance[0] = -1.0
        self.pub.publish(msg)


rclpy.init()
rclpy.spin(FakeImu())
