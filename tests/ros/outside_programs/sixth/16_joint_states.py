"""Joint states: a swinging arm published at 20 Hz, a listener that finds the extremes by name, a logger at levels."""
import math
import rclpy
from builtin_interfaces.msg import Time as TimeMsg
from rclpy.clock import Clock, ClockType
from rclpy.executors import SingleThreadedExecutor
from rclpy.logging import LoggingSeverity
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import Header


class Arm(Node):
    def __init__(self, **kw):
        super().__init__("arm", **kw)
        self.pub = self.create_publisher(JointState, "~/joint_states", 10)
        self.rate = self.create_timer(1 / 20, self.tick)
        self.i = 0

    def tick(self):
        self.i += 1
        a = math.sin(2 * math.pi * self.i / 40)
        self.pub.publish(JointState(header=Header(stamp=self.get_clock().now().to_msg(), frame_id="base"), name=["shoulder", "elbow"], position=[a, -0.5 * a], velocity=[], effort=[0.0, 0.0]))


class Watch(Node):
    def __init__(self):
        super().__init__("watch", namespace="lab")
        self.lo, self.hi = {}, {}
        self.sub = self.create_subscription(JointState, "/lab/arm/joint_states", self.on, 10)
        self.stamps = []

    def on(self, m: JointState):
        for n, p in zip(m.name, m.position):
            self.lo[n] = min(self.lo.get(n, p), p)
            self.hi[n] = max(self.hi.get(n, p), p)
        self.stamps.append(rclpy.time.Time.from_msg(m.header.stamp).nanoseconds)


rclpy.init()
a, w = Arm(namespace="/lab"), Watch()
w.get_logger().set_level(LoggingSeverity.DEBUG)
w.get_logger().debug("watching")
a.get_logger().debug("never shown")
a.get_logger().get_child("joint").error("an error", once=True)
for k in range(3):
    a.get_logger().warning("skipped once", skip_first=True)
ex = SingleThreadedExecutor()
ex.add_node(a)
ex.add_node(w)
while len(w.stamps) < 80 and ex.context.ok():
    ex.spin_once()
gaps = {round((q - p) / 1e6) for p, q in zip(w.stamps, w.stamps[1:])}
print({n: (round(w.lo[n], 2), round(w.hi[n], 2)) for n in sorted(w.lo)}, gaps)
print(a.get_fully_qualified_name(), w.get_name(), w.get_namespace(), w.count_publishers("/lab/arm/joint_states"), sorted(n for n in w.get_node_names()if n in("arm","watch")))
ex.shutdown()
a.destroy_node(); w.destroy_node()
rclpy.shutdown()
