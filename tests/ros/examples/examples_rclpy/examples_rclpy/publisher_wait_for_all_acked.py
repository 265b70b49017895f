"""Publishes, and waits until every subscription has acknowledged."""

import rclpy
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import QoSProfile, QoSReliabilityPolicy
from std_msgs.msg import String


class MinimalPublisher(Node):
    def __init__(self):
        super().__init__("minimal_publisher_with_wait_for_all_acked")
        reliable = QoSProfile(depth=10, reliability=QoSReliabilityPolicy.RELIABLE)
        self.publisher_ = self.create_publisher(String, "topic", reliable)
        self.timer = self.create_timer(0.5, self.timer_callback)
        self.i = 0
        self.wait_timeout = 3

    def timer_callback(self):
        msg = String()
        msg.data = "Hello World: %d" % self.i
        self.i += 1
        self.publisher_.publish(msg)
        if self.publisher_.wait_for_all_acked(Duration(seconds=self.wait_timeout)):
            self.get_logger().info('Published and acknowledged: "%s"' % msg.data)
        else:
            self.get_logger().info('Not acknowledged in time: "%s"' % msg.data)


def main(args=None):
    rclpy.init(args=args)
    node = MinimalPublisher()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass


if __name__ == "__main__":
    main()
