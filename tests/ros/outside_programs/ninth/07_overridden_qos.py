"""Quality of service that is set from outside, events of it, and what is told of endpoints."""

import rclpy
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    QoSCompatibility,
    QoSPolicyKind,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
    qos_check_compatible,
)
from rclpy.qos_overriding_options import QosCallbackResult, QoSOverridingOptions
from std_msgs.msg import String


class Talker(Node):
    def __init__(self):
        super().__init__(
            "talker",
            parameter_overrides=[
                Parameter("qos_overrides./chatter.publisher.reliability", value="best_effort"),
                Parameter("qos_overrides./chatter.publisher.depth", value=3),
            ],
        )
        options = QoSOverridingOptions(
            policy_kinds=(QoSPolicyKind.RELIABILITY, QoSPolicyKind.DEPTH, QoSPolicyKind.HISTORY),
            callback=self.check,
        )
        self.pub = self.create_publisher(
            String,
            "/chatter",
            QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE, deadline=Duration(seconds=1)),
            qos_overriding_options=options,
            event_callbacks=PublisherEventCallbacks(incompatible_qos=self.incompatible, matched=self.matched),
        )
        self.kept = self.create_publisher(
            String, "/kept", QoSProfile(depth=2, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        )
        for word in ("one", "two", "three"):
            self.kept.publish(String(data=word))
        self.number = 0
        self.timer = self.create_timer(0.5, self.talk)

    def check(self, profile):
        result = QosCallbackResult()
        result.successful = profile.depth >= 2
        result.reason = "too shallow"
        return result

    def incompatible(self, event):
        self.get_logger().info(f"nobody gets it: {event.total_count} {QoSPolicyKind(event.last_policy_kind).name}")

    def matched(self, event):
        self.get_logger().info(f"matched {event.current_count}")

    def talk(self):
        self.number += 1
        if self.number == 6:
            self.timer.cancel()
        self.pub.publish(String(data=str(self.number)))


class Listener(Node):
    def __init__(self):
        super().__init__("listener")
        self.strict, self.loose, self.kept = [], [], []
        self.create_subscription(
            String,
            "/chatter",
            lambda msg: self.strict.append(msg.data),
            QoSProfile(depth=5),
            event_callbacks=SubscriptionEventCallbacks(incompatible_qos=self.incompatible),
        )
        self.create_subscription(
            String,
            "/chatter",
            lambda msg: self.loose.append(msg.data),
            QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT, deadline=Duration(seconds=1)),
            event_callbacks=SubscriptionEventCallbacks(deadline=self.late),
        )
        self.lates = 0
        self.create_timer(1.0, self.subscribe_late)
        self.create_timer(6.2, self.report)

    def incompatible(self, event):
        self.get_logger().info(f"I get nothing: {QoSPolicyKind(event.last_policy_kind).name}")

    def late(self, event):
        self.lates += 1

    def subscribe_late(self):
        if not hasattr(self, "late_subscription"):
            profile = QoSProfile(depth=5, durability=DurabilityPolicy.TRANSIENT_LOCAL)
            self.late_subscription = self.create_subscription(
                String, "/kept", lambda msg: self.kept.append(msg.data), profile
            )

    def report(self):
        print("strict", self.strict, "loose", self.loose, "kept", self.kept, "late", 2 <= self.lates <= 4, flush=True)
        info = self.get_publishers_info_by_topic("/chatter")[0]
        print(info.node_name, info.topic_type, info.qos_profile.reliability.name, flush=True)
        print("subscriptions", len(self.get_subscriptions_info_by_topic("/chatter")), flush=True)
        raise KeyboardInterrupt


def main():
    rclpy.init()
    verdict, reason = qos_check_compatible(
        QoSPresetProfiles.SENSOR_DATA.value, QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE)
    )
    print("check:", verdict == QoSCompatibility.ERROR, "best effort" in reason.lower().replace("-", " "))
    try:
        QoSProfile(history=HistoryPolicy.KEEP_LAST)
    except Exception as error:
        print(type(error).__name__)
    executor = rclpy.executors.SingleThreadedExecutor()
    talker, listener = Talker(), Listener()
    print(sorted(talker.get_parameters_by_prefix("qos_overrides./chatter.publisher")))
    executor.add_node(talker)
    executor.add_node(listener)
    try:
        executor.spin()
    except KeyboardInterrupt:
        print("over")
    rclpy.shutdown()


if __name__ == "__main__":
    main()
