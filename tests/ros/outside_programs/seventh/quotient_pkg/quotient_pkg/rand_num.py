import random
import rclpy
from rclpy.node import Node
from std_msgs.msg import Int16


class RandNum(Node):
    def __init__(self):
        super().__init__('rand_num')
        self.rng = random.Random(5)
        self.publisher_ = self.create_publisher(Int16, 'rand_num', 10)
        self.timer = self.create_timer(1 / 20, self.tick)

    def tick(self):
        msg = Int16()
        msg.data = self.rng.randint(1, 100)
        self.publisher_.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    node = RandNum()
    rclpy.spin(node)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
