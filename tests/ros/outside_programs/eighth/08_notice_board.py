"""What a reader of a board finds that comes late, by the quality of service of both."""

import rclpy
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
    qos_check_compatible,
)
from std_msgs.msg import String

KEPT = QoSProfile(
    depth=3,
    history=HistoryPolicy.KEEP_LAST,
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
)
VOLATILE = QoSProfile(depth=10)


class Board(Node):
    def __init__(self):
        super().__init__("board")
        self.events = PublisherEventCallbacks(incompatible_qos=self.on_incompatible)
        self.kept = self.create_publisher(String, "notices", KEPT, event_callbacks=self.events)
        self.plain = self.create_publisher(String, "plain", VOLATILE, event_callbacks=self.events)
        for number in range(5):
            self.kept.publish(String(data=f"notice {number}"))
            self.plain.publish(String(data=f"plain {number}"))
        self.found = {}
        self.readers = []
        self.create_timer(0.5, self.come)
        self.finish = self.create_timer(2.0, self.report)

    def on_incompatible(self, info):
        self.get_logger().info(f"a reader asks for more: {info.total_count}")

    def reader(self, name, topic, profile, **options):
        self.found[name] = []
        self.readers.append(
            self.create_subscription(String, topic, lambda message: self.found[name].append(message.data), profile, **options)
        )

    def come(self):
        if self.readers:
            return
        one = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.reader("late", "notices", KEPT)
        self.reader("last only", "notices", one)
        self.reader("volatile", "notices", VOLATILE)
        self.reader("unheard", "plain", KEPT, event_callbacks=SubscriptionEventCallbacks(incompatible_qos=self.on_refused))
        self.reader("sensor", "notices", QoSPresetProfiles.SENSOR_DATA.value)

    def on_refused(self, info):
        self.get_logger().info(f"refused for {info.last_policy_kind.name}")

    def report(self):
        self.finish.cancel()
        self.kept.publish(String(data="goodbye"))
        self.plain.publish(String(data="farewell"))
        self.create_timer(0.5, self.end)

    def end(self):
        for name, texts in self.found.items():
            self.get_logger().info(f"{name}: {', '.join(texts)}.")
        kind, reason = qos_check_compatible(VOLATILE, KEPT)
        self.get_logger().info(f"compatible: {kind.name}")
        self.get_logger().info(f"readers of notices: {self.kept.get_subscription_count()}")
        infos = self.get_subscriptions_info_by_topic("/notices")
        kept = [each for each in infos if each.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL]
        self.get_logger().info(f"of them with kept messages: {len(kept)} of {len(infos)}")
        raise SystemExit


def main():
    rclpy.init()
    try:
        rclpy.spin(Board())
    except SystemExit:
        pass


if __name__ == "__main__":
    main()
