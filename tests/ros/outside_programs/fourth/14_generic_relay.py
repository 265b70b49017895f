"""topic_tools in fifty lines: relays a topic of any type, and throttles it."""
import sys

import rclpy
from rclpy.node import Node
from rclpy.qos import QoSPresetProfiles, QoSProfile, ReliabilityPolicy
from rosidl_runtime_py import message_to_csv, message_to_ordereddict, message_to_yaml, set_message_fields
from rosidl_runtime_py.utilities import get_message


class Relay(Node):
    def __init__(self, source, target, rate):
        super().__init__("relay")
        self.source = self.resolve_topic_name(source)
        self.target, self.period = target, int(1e9 / rate)
        self.pub = None
        self.next = 0
        self.sent = 0
        self.search = self.create_timer(0.2, self.find)

    def find(self):
        types = dict(self.get_topic_names_and_types()).get(self.source)
        if not types:
            return
        self.search.destroy()
        self.type = get_message(types[0])
        self.pub = self.create_publisher(self.type, self.target, QoSProfile(depth=5))
        qos = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
        self.create_subscription(self.type, self.source, self.forward, qos)
        self.get_logger().info(f"found {self.source} [{types[0]}]")

    def forward(self, msg):
        now = self.get_clock().now().nanoseconds
        if now < self.next:
            return
        self.next = now + self.period
        self.pub.publish(msg)
        self.sent += 1
        if self.sent == 1:
            fields = message_to_ordereddict(msg)
            print(list(fields), msg.get_fields_and_field_types()["x"])
            print(message_to_yaml(msg).splitlines()[0])
            print(len(message_to_csv(msg).split(",")))
            other = self.type()
            set_message_fields(other, {"x": 1.5, "theta": -1})
            print(other == self.type(x=1.5, theta=-1.0), other)
        if self.sent == 10:
            raise KeyboardInterrupt


def main():
    rclpy.init(args=sys.argv)
    words = rclpy.utilities.remove_ros_args(sys.argv)[1:]
    node = Relay(words[0], words[1], float(words[2]))
    print(QoSPresetProfiles.get_from_short_key("sensor_data").depth)
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    node.get_logger().warn("relayed %d" % node.sent)
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
