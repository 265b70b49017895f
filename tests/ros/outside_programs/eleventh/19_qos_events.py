import rclpy
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import (DurabilityPolicy, HistoryPolicy, QoSCompatibility, QoSDurabilityPolicy, QoSPolicyKind,
                       QoSProfile, QoSReliabilityPolicy, ReliabilityPolicy, qos_check_compatible)
from std_msgs.msg import Int32


class Clinic(Node):
    def __init__(self):
        super().__init__('talker')
        self.told = {}
        self.current = []
        self.deadline_qos = QoSProfile(depth=10, deadline=Duration(seconds=0.5))
        self.ticking = self.create_publisher(
            Int32, 'ticks', self.deadline_qos,
            event_callbacks=PublisherEventCallbacks(deadline=lambda event: self.tell('offered', event.total_count)))
        self.create_subscription(
            Int32, 'ticks', lambda msg: None, self.deadline_qos,
            event_callbacks=SubscriptionEventCallbacks(
                deadline=lambda event: self.tell('requested', event.total_count)))
        self.latched_qos = QoSProfile(
            history=HistoryPolicy.KEEP_LAST, depth=3, reliability=ReliabilityPolicy.RELIABLE,
            durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.latched = self.create_publisher(
            Int32, 'latched', self.latched_qos,
            event_callbacks=PublisherEventCallbacks(matched=lambda event: self.current.append(event.current_count)))
        self.volatile = self.create_publisher(
            Int32, 'volatile', 10,
            event_callbacks=PublisherEventCallbacks(incompatible_qos=self.on_incompatible, use_default_callbacks=False))
        self.short = self.create_publisher(Int32, 'short', QoSProfile(
            depth=5, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL, lifespan=Duration(seconds=0.2)))

    def tell(self, name, count):
        if name not in self.told:
            self.told[name] = count
            print(name, 'deadline missed', count)

    def on_incompatible(self, event):
        kind = QoSPolicyKind(event.last_policy_kind)
        print('incompatible:', kind.name)

    def pause(self, seconds):
        future = rclpy.task.Future()
        timer = self.create_timer(seconds, lambda: future.done() or future.set_result(None))
        rclpy.spin_until_future_complete(self, future)
        self.destroy_timer(timer)


def main():
    rclpy.init()
    node = Clinic()
    for n in range(5):
        node.ticking.publish(Int32(data=n))
        node.pause(0.1)
    node.pause(0.8)

    wanting = QoSProfile(depth=10, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL,
                         reliability=QoSReliabilityPolicy.RELIABLE)
    compatibility, reason = qos_check_compatible(QoSProfile(depth=10), wanting)
    assert compatibility == QoSCompatibility.ERROR and reason, reason
    wrong = node.create_subscription(
        Int32, 'volatile', print, wanting,
        event_callbacks=SubscriptionEventCallbacks(incompatible_qos=lambda event: None))
    node.pause(0.3)
    node.destroy_subscription(wrong)

    matched = node.create_subscription(Int32, 'latched', lambda msg: None, node.latched_qos)
    node.pause(0.2)
    node.destroy_subscription(matched)
    node.pause(0.2)
    print('matched', max(node.current), 'then', node.current[-1])

    for n in range(10):
        node.latched.publish(Int32(data=n))
    node.short.publish(Int32(data=1))
    node.pause(0.5)
    late, expired = [], []
    node.create_subscription(Int32, 'latched', lambda msg: late.append(msg.data), node.latched_qos)
    node.create_subscription(Int32, 'short', lambda msg: expired.append(msg.data), wanting)
    node.pause(0.5)
    print('late joiner', late)
    print('expired:', expired)
    info = node.get_publishers_info_by_topic('/latched')[0]
    qos = info.qos_profile
    print('info:', info.node_name, qos.reliability.name, qos.durability.name, max(qos.depth, 3))
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
