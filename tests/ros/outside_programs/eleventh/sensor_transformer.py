import rclpy
import tf2_geometry_msgs  # noqa: F401  registers PointStamped
import tf2_ros
from geometry_msgs.msg import PointStamped
from rclpy.duration import Duration
from rclpy.node import Node


class Transformer(Node):
    def __init__(self):
        super().__init__('transformer')
        self.buffer = tf2_ros.Buffer(cache_time=Duration(seconds=5))
        self.listener = tf2_ros.TransformListener(self.buffer, self, spin_thread=False)
        self.robot = self.create_publisher(PointStamped, 'robot_coord', 10)
        self.world = self.create_publisher(PointStamped, 'world_coord', 10)
        self.timer = self.create_timer(0.1, self.ready)

    def ready(self):
        if self.buffer.can_transform('world', 'sensor', rclpy.time.Time()):
            self.timer.cancel()
            self.create_subscription(PointStamped, 'sensor_coord', self.on_point, 10)

    def on_point(self, msg):
        in_robot = self.buffer.transform(msg, 'robot')
        transform = self.buffer.lookup_transform('world', msg.header.frame_id, msg.header.stamp)
        in_world = tf2_geometry_msgs.do_transform_point(msg, transform)
        in_world.header.stamp = in_robot.header.stamp = msg.header.stamp
        self.robot.publish(in_robot)
        self.world.publish(in_world)


def main():
    rclpy.init()
    rclpy.spin(Transformer())


if __name__ == '__main__':
    main()
