import rclpy
from rclpy.node import Node
from std_msgs.msg import Int32


class Belt(Node):
    def __init__(self):
        super().__init__('belt')
        self.declare_parameter('period', 1.0)
        self.declare_parameter('weights', [1])
        self.declare_parameter('label', 'none')
        self.declare_parameter('site', 'nowhere')
        self.items = list(self.get_parameter('weights').value)
        self.out = self.create_publisher(Int32, 'items', 10)
        self.timer = self.create_timer(self.get_parameter('period').value, self.send)
        self.get_logger().info(
            f"{self.get_fully_qualified_name()} label {self.get_parameter('label').value} "
            f"site {self.get_parameter('site').value} to {self.out.topic_name}")

    def send(self):
        if self.items:
            self.out.publish(Int32(data=self.items.pop(0)))
        else:
            self.timer.cancel()


def main():
    rclpy.init()
    node = Belt()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
