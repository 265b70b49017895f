"""A node notices when subscriptions and publishers of other nodes come and go."""

import rclpy
from example_interfaces.msg import String
from rclpy.event_handler import (
    PublisherEventCallbacks,
    QoSPublisherMatchedInfo,
    QoSSubscriptionMatchedInfo,
    SubscriptionEventCallbacks,
)
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future


class MatchedEventDetectNode(Node):
    def __init__(self, pub_topic_name, sub_topic_name):
        super().__init__("matched_event_detection_node")
        pub_events = PublisherEventCallbacks(matched=self.on_subscriptions)
        self.pub = self.create_publisher(String, pub_topic_name, 10, event_callbacks=pub_events)
        sub_events = SubscriptionEventCallbacks(matched=self.on_publishers)
        self.sub = self.create_subscription(
            String, sub_topic_name, lambda msg: None, 10, event_callbacks=sub_events
        )

    def on_subscriptions(self, info: QoSPublisherMatchedInfo):
        self.get_logger().info(f"subscriptions: {info.current_count} ({info.current_count_change:+d})")
        self.future.set_result(True)

    def on_publishers(self, info: QoSSubscriptionMatchedInfo):
        self.get_logger().info(f"publishers: {info.current_count} ({info.current_count_change:+d})")
        self.future.set_result(True)

    def get_future(self):
        self.future = Future()
        return self.future


def main(args=None):
    try:
        with rclpy.init(args=args):
            matched_node = MatchedEventDetectNode("pub_topic", "sub_topic")
            multi_sub_node = Node("multi_sub_node")
            multi_pub_node = Node("multi_pub_node")
            executor = SingleThreadedExecutor()
            for node in (matched_node, multi_sub_node, multi_pub_node):
                executor.add_node(node)

            def wait():
                executor.spin_until_future_complete(matched_node.get_future(), 10)

            subs = []
            for _ in range(2):
                subs.append(multi_sub_node.create_subscription(String, "pub_topic", lambda msg: None, 10))
                wait()
            for sub in subs:
                multi_sub_node.destroy_subscription(sub)
                wait()
            pubs = []
            for _ in range(2):
                pubs.append(multi_pub_node.create_publisher(String, "sub_topic", 10))
                wait()
            for pub in pubs:
                multi_pub_node.destroy_publisher(pub)
                wait()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
