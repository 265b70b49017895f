#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from example_interfaces.msg import Int64
from example_interfaces.srv import SetBool


class NumberPublisher(Node):
    """Publishes 2 each second; after the fifth it first asks for no reset, after the sixth for a reset"""

    def __init__(self):
        super().__init__("number_publisher")
        self.sent_ = 0
        self.pub_ = self.create_publisher(Int64, "number", 10)
        self.client_ = self.create_client(SetBool, "reset_counter")
        self.timer_ = self.create_timer(1.0, self.publish_number)

    def publish_number(self):
        if not self.client_.service_is_ready() or self.pub_.get_subscription_count() == 0:
            return
        self.pub_.publish(Int64(data=2))
        self.sent_ += 1
        if self.sent_ in (5, 6):
            # half a second later
            self.once_ = self.create_timer(0.5, self.ask)

    def ask(self):
        self.once_.cancel()
        future = self.client_.call_async(SetBool.Request(data=self.sent_ == 6))
        future.add_done_callback(lambda f: self.get_logger().info(f"{f.result().success}: {f.result().message}"))


def main():
    rclpy.init()
    rclpy.spin(NumberPublisher())


if __name__ == "__main__":
    main()
