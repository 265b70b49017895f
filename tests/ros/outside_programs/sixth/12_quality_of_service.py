"""QoS: latched late joiner, incompatible pair with event, depth, deadline, best effort."""
import rclpy
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy, QoSPresetProfiles
from std_msgs.msg import Int32, String


class N(Node):
    def __init__(self):
        super().__init__("qos_demo")
        latched = QoSProfile(depth=2, durability=DurabilityPolicy.TRANSIENT_LOCAL, history=HistoryPolicy.KEEP_LAST)
        self.pub = self.create_publisher(String, "map_name", latched)
        for w in "abc":
            self.pub.publish(String(data=w))
        self.got = []
        self.missed = 0
        self.bad = []
        self.be = self.create_publisher(Int32, "n", QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT),
                                        event_callbacks=PublisherEventCallbacks(incompatible_qos=lambda e: self.bad.append(("pub", e.total_count))))
        self.create_subscription(Int32, "n", lambda m: self.bad.append("msg"), QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE),
                                 event_callbacks=SubscriptionEventCallbacks(incompatible_qos=lambda e: self.bad.append(("sub", e.total_count))))
        dl = QoSProfile(depth=5, deadline=Duration(seconds=0.2))
        self.d = self.create_publisher(Int32, "dead", dl)
        self.create_subscription(Int32, "dead", lambda m: None, dl, event_callbacks=SubscriptionEventCallbacks(deadline=self.on_missed))
        self.create_timer(0.5, self.late)
        self.sent = 0
        self.k = self.create_timer(0.1, self.send)
        self.latched = latched

    def on_missed(self, e):
        self.missed = e.total_count

    def send(self):
        self.sent += 1
        self.be.publish(Int32(data=self.sent))
        if self.sent <= 5:
            self.d.publish(Int32(data=self.sent))
        if self.sent == 15:
            print("latched", self.got, "bad", sorted(self.bad), "missed", self.missed >= 3)
            print(QoSPresetProfiles.SENSOR_DATA.value.reliability.name, self.pub.get_subscription_count())
            raise SystemExit

    def late(self):
        if not hasattr(self, "s"):
            self.s = self.create_subscription(String, "map_name", lambda m: self.got.append(m.data), self.latched)


rclpy.init()
node = N()
try:
    rclpy.spin(node)
except SystemExit:
    print("bye")
node.destroy_node()
rclpy.shutdown()
