import numpy as np
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import PointCloud2
from sensor_msgs_py.point_cloud2 import read_points, read_points_list


class CloudReader(Node):
    def __init__(self):
        super().__init__('cloud_reader')
        self.create_subscription(PointCloud2, 'cloud', self.on_cloud, 5)

    def on_cloud(self, cloud):
        pts = read_points(cloud, field_names=('x', 'y'), skip_nans=True)
        x, y = pts['x'], pts['y']
        self.get_logger().info('box %.0f..%.0f x %.0f..%.0f, step %d' % (
            x.min(), x.max(), y.min(), y.max(), cloud.point_step), once=True)
        first = read_points_list(cloud)[0]
        self.get_logger().info('first x=%.0f intensity=%.0f' % (first.x, first.intensity), once=True)
        far = np.hypot(x, y).max()
        self.get_logger().info(f'corner at {far:.1f} m', once=True)


rclpy.init()
rclpy.spin(CloudReader())
