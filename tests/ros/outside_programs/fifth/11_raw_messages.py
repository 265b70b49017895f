"""Bytes on the wire: raw subscriptions and serialized publishing."""
import rclpy
from geometry_msgs.msg import Twist, Vector3
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.serialization import deserialize_message, serialize_message


class Sniffer(Node):
    def __init__(self):
        super().__init__('sniffer')
        self.sizes = set()
        self.create_subscription(Odometry, 'odom', self.on_raw, 10, raw=True)
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)

    def on_raw(self, data):
        self.sizes.add(len(data))
        odom = deserialize_message(data, Odometry)
        forward = Twist(linear=Vector3(x=0.25 if odom.pose.pose.position.x < 1.0 else 0.0))
        self.pub.publish(serialize_message(forward))
        if forward.linear.x == 0.0:
            self.get_logger().info(f'bytes {type(data).__name__} sizes {len(self.sizes)} header {bytes(data[:4]).hex()}')
            self.get_logger().info(f'twist {len(serialize_message(forward))} bytes')
            raise KeyboardInterrupt


rclpy.init()
node = Sniffer()
try:
    rclpy.spin(node)
except KeyboardInterrupt:
    print('interrupted')
finally:
    node.destroy_node()
    rclpy.try_shutdown()
