import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class Talker(Node):
    def __init__(self):
        super().__init__("talker")
        self.word = self.declare_parameter("word", "default").value
        self.limit = self.declare_parameter("limit", 4).value
        self.pub = self.create_publisher(String, "chatter", 10)
        self.n = 0
        self.create_timer(self.declare_parameter("period", 1.0).value, self.tick)

    def tick(self):
        self.n += 1
        self.pub.publish(String(data=f"{self.word} {self.n}"))
        if self.n == self.limit:
            raise SystemExit(0)


def main(args=None):
    rclpy.init(args=args)
    node = Talker()
    try:
        rclpy.spin(node)
    except SystemExit:
        node.get_logger().info("talked enough")
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
