import statistics
from functools import partial

import rclpy
from rclpy.node import Node
from std_msgs.msg import Float32


class Summary(Node):

    def __init__(self):
        super().__init__('summary')
        self.declare_parameter('period', 1.0)
        self.values = {}
        self.known = {}
        self.create_timer(0.5, self.discover)
        self.create_timer(self.get_parameter('period').value, self.tell)

    def discover(self):
        for topic, types in self.get_topic_names_and_types():
            if 'std_msgs/msg/Float32' in types and topic not in self.known:
                self.known[topic] = self.create_subscription(Float32, topic, partial(self.on_value, topic), 10)

    def on_value(self, topic, msg):
        self.values.setdefault(topic, []).append(msg.data)

    def tell(self):
        for topic, values in sorted(self.values.items()):
            self.get_logger().info(f'{topic}: {len(values)} values, mean {statistics.mean(values):.1f}')
        self.values.clear()


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Summary())
