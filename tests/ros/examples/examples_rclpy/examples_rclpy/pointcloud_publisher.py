"""Publishes a surface of points that moves up and down, made with numpy."""

import numpy as np
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import PointCloud2, PointField
from sensor_msgs_py import point_cloud2
from std_msgs.msg import Header


class PointCloudPublisher(Node):
    rate = 30
    width = height = 20
    moving = True

    header = Header()
    header.frame_id = "map"
    fields = [
        PointField(name="x", offset=0, datatype=PointField.FLOAT32, count=1),
        PointField(name="y", offset=4, datatype=PointField.FLOAT32, count=1),
        PointField(name="z", offset=8, datatype=PointField.FLOAT32, count=1),
        PointField(name="intensity", offset=12, datatype=PointField.FLOAT32, count=1),
    ]

    def __init__(self):
        super().__init__("pc_publisher")
        self.publisher_ = self.create_publisher(PointCloud2, "test_cloud", 10)
        self.timer = self.create_timer(1 / self.rate, self.timer_callback)
        self.counter = 0

    def timer_callback(self):
        self.header.stamp = self.get_clock().now().to_msg()
        x, y = np.meshgrid(np.linspace(-2, 2, self.width), np.linspace(-2, 2, self.height))
        z = 0.5 * np.sin(2 * x - self.counter / 10.0) * np.sin(2 * y)
        points = np.array([x, y, z, z]).reshape(4, -1).T
        self.publisher_.publish(point_cloud2.create_cloud(self.header, self.fields, points))
        if self.counter == 0:
            self.get_logger().info(f"{len(points)} points")
        if self.moving:
            self.counter += 1


def main(args=None):
    rclpy.init(args=args)
    node = PointCloudPublisher()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass


if __name__ == "__main__":
    main()
