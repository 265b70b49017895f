import math

import rclpy
from rclpy.node import Node
from tf2_ros import TransformException
from tf2_ros.buffer import Buffer
from tf2_ros.transform_listener import TransformListener
from geometry_msgs.msg import Twist


class FrameListener(Node):

    def __init__(self):
        super().__init__('robot_tf2_frame_listener')
        self.source_frame = self.declare_parameter(
            'source_frame', 'base_link').get_parameter_value().string_value
        self.tf_buffer = Buffer()
        self.tf_listener = TransformListener(self.tf_buffer, self)
        self.publisher = self.create_publisher(Twist, 'cmd_vel', 1)
        self.timer = self.create_timer(0.25, self.on_timer)
        self.seen = False

    def on_timer(self):
        try:
            t = self.tf_buffer.lookup_transform('odom', self.source_frame, rclpy.time.Time())
        except TransformException as ex:
            self.get_logger().info(f'Could not transform odom to {self.source_frame}: {ex}')
            return
        msg = Twist()
        q = t.transform.rotation
        yaw = 2 * math.atan2(q.z, q.w)
        yaw = math.atan2(math.sin(yaw), math.cos(yaw))
        x = t.transform.translation.x
        y = t.transform.translation.y
        if x < 1.5:
            # lane keeping on the line y = 0.5
            msg.linear.x = 0.3
            msg.angular.z = max(-0.6, min(0.6, 2.0 * (0.5 - y) - 1.8 * yaw))
        elif not self.seen:
            self.seen = True
            self.get_logger().info('crossed x=1.5 at y=%.1f' % y)
        self.publisher.publish(msg)


def main():
    rclpy.init()
    node = FrameListener()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    rclpy.shutdown()


if __name__ == '__main__':
    main()
