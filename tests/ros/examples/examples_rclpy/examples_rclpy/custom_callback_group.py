"""A callback group of the program's own, which lets only so many callbacks through in a while."""

import threading

import rclpy
from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from std_msgs.msg import String


class ThrottledCallbackGroup(CallbackGroup):
    def __init__(self, node):
        super().__init__()
        self.timer = node.create_timer(0.5, self.timer_callback)
        self.bucket = 10
        self.bucket_max = 10
        self.lock = threading.Lock()

    def can_execute(self, entity):
        return self.bucket > 0

    def beginning_execution(self, entity):
        with self.lock:
            if self.bucket > 0:
                self.bucket -= 1
                return True
            return False

    def ending_execution(self, entity):
        pass

    def timer_callback(self):
        with self.lock:
            if self.bucket < self.bucket_max:
                self.bucket += 1


class ThrottledTalker(Node):
    def __init__(self):
        super().__init__("intermittent_talker")
        self.i = 0
        self.pub = self.create_publisher(String, "chatter", 10)
        self.group = ThrottledCallbackGroup(self)
        self.timer = self.create_timer(0.1, self.timer_callback, callback_group=self.group)

    def timer_callback(self):
        msg = String()
        msg.data = "Hello World: {0}".format(self.i)
        self.i += 1
        now = self.get_clock().now().nanoseconds / 1e9
        self.get_logger().info('Publishing at %.1f: "%s"' % (now, msg.data))
        self.pub.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    node = ThrottledTalker()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass


if __name__ == "__main__":
    main()
