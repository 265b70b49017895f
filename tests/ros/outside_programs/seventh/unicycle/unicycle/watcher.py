import rclpy
from rclpy.node import Node
from tf2_ros import TransformException
from tf2_ros.buffer import Buffer
from tf2_ros.transform_listener import TransformListener


class Watcher(Node):
    def __init__(self):
        super().__init__('watcher')
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.create_timer(1.0, self.tell)
        self.far = 0.0

    def tell(self):
        try:
            t = self.buffer.lookup_transform('world', 'base_link', rclpy.time.Time())
        except TransformException as ex:
            self.get_logger().info(f'no transform yet: {ex}')
            return
        p = t.transform.translation
        self.far = max(self.far, (p.x ** 2 + p.y ** 2) ** 0.5)
        self.get_logger().info(f'at ({p.x:.2f}, {p.y:.2f}), farthest {self.far:.2f}')


def main():
    rclpy.init()
    rclpy.spin(Watcher())
