"""QoS events: an incompatible pair seen from both sides, a missed deadline, a lost liveliness, matches.

Meant: the reliable subscriber hears nothing of the best-effort publisher, both are told why; a
publisher that falls silent misses its deadline on both sides; matched events count up and down.
"""
import rclpy
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import (LivelinessPolicy, QoSPolicyKind, QoSProfile, ReliabilityPolicy,
                       qos_check_compatible, QoSCompatibility)
from std_msgs.msg import String


class Clinic(Node):
    def __init__(self):
        super().__init__('clinic')
        self.told = []
        self.heard = 0
        weak = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
        strong = QoSProfile(depth=5, reliability=ReliabilityPolicy.RELIABLE)
        compatibility, reason = qos_check_compatible(weak, strong)
        print('checked', compatibility == QoSCompatibility.ERROR, 'best effort' in reason.lower())
        self.a = self.create_publisher(
            String, 'a', weak, event_callbacks=PublisherEventCallbacks(
                incompatible_qos=lambda e: self.tell('publisher', e), use_default_callbacks=False))
        self.b = self.create_subscription(
            String, 'a', self.hear, strong, event_callbacks=SubscriptionEventCallbacks(
                incompatible_qos=lambda e: self.tell('subscriber', e), use_default_callbacks=False))

        timed = QoSProfile(depth=5, deadline=Duration(seconds=0.5))
        self.misses = {'publisher': 0, 'subscriber': 0}
        self.matches = []
        self.c = self.create_publisher(String, 'c', timed, event_callbacks=PublisherEventCallbacks(
            deadline=lambda e: self.miss('publisher', e)))
        self.create_subscription(String, 'c', lambda m: None, timed,
                                 event_callbacks=SubscriptionEventCallbacks(
                                     deadline=lambda e: self.miss('subscriber', e)))
        alive = QoSProfile(depth=5, liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
                           liveliness_lease_duration=Duration(seconds=0.4))
        self.alive = []
        self.d = self.create_publisher(String, 'd', alive)
        self.create_subscription(String, 'd', lambda m: None, alive,
                                 event_callbacks=SubscriptionEventCallbacks(
                                     liveliness=lambda e: self.alive.append(e.alive_count)))
        self.e = self.create_publisher(String, 'e', 10, event_callbacks=PublisherEventCallbacks(
            matched=lambda e: self.matches.append(e.current_count)))
        self.ticks = 0
        self.create_timer(0.2, self.tick)

    def tell(self, who, event):
        self.told.append((who, event.total_count, event.last_policy_kind == QoSPolicyKind.RELIABILITY))

    def miss(self, who, event):
        self.misses[who] = event.total_count

    def hear(self, _message):
        self.heard += 1

    def tick(self):
        self.ticks += 1
        self.a.publish(String(data='nobody hears'))
        if self.ticks <= 10:
            self.c.publish(String(data='in time'))
            self.d.assert_liveliness()
        if self.ticks == 5:
            self.late = self.create_subscription(String, 'e', lambda m: None, 10)
        if self.ticks == 10:
            self.destroy_subscription(self.late)
            self.on_time = dict(self.misses)


def main(args=None):
    rclpy.init(args=args)
    clinic = Clinic()
    while clinic.ticks < 20:
        rclpy.spin_once(clinic, timeout_sec=0.1)
    print('told', sorted(clinic.told), 'heard', clinic.heard)
    print('on time', clinic.on_time)
    print('missed', clinic.misses['publisher'] >= 2, clinic.misses['subscriber'] >= 2)
    print('alive', clinic.alive[0], clinic.alive[-1])
    print('matched', clinic.matches)
    clinic.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
