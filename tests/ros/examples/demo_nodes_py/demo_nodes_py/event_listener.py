"""Listens to the events of the service of ``introspection``."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden


class EventListener(Node):
    def __init__(self):
        super().__init__("event_listener")
        self.create_timer(0.2, self.look)
        self.seen = set()

    def look(self):
        for name, types in self.get_topic_names_and_types():
            if topic_or_service_is_hidden(name) and name not in self.seen:
                self.seen.add(name)
                self.get_logger().info(f"{name} {types}")


def main(args=None):
    try:
        with rclpy.init(args=args):
            node = EventListener()
            rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
