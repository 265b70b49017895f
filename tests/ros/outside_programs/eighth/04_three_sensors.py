"""Three sensors at different rates, matched by time; a cache is asked for what was there a while ago."""

import message_filters
import rclpy
from geometry_msgs.msg import PointStamped
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Imu, Range, Temperature
from std_msgs.msg import Header


class Sensors(Node):
    def __init__(self):
        super().__init__("sensors")
        self.fast = self.create_publisher(Imu, "imu", qos_profile_sensor_data)
        self.middle = self.create_publisher(Range, "range", qos_profile_sensor_data)
        self.slow = self.create_publisher(Temperature, "temperature", 10)
        self.create_timer(0.02, lambda: self.fast.publish(Imu(header=self.head("imu"))))
        self.create_timer(0.05, lambda: self.middle.publish(Range(header=self.head("sonar"), range=1.5)))
        self.create_timer(0.2, lambda: self.slow.publish(Temperature(header=self.head("room"), temperature=21.0)))
        self.start = self.get_clock().now()

    def head(self, frame):
        return Header(stamp=self.get_clock().now().to_msg(), frame_id=frame)


class Fusion(Node):
    def __init__(self):
        super().__init__("fusion")
        imu = message_filters.Subscriber(self, Imu, "imu", qos_profile=qos_profile_sensor_data)
        sonar = message_filters.Subscriber(self, Range, "range", qos_profile=qos_profile_sensor_data)
        heat = message_filters.Subscriber(self, Temperature, "temperature")
        self.cache = message_filters.Cache(imu, 100)
        self.near = message_filters.ApproximateTimeSynchronizer([imu, sonar, heat], queue_size=20, slop=0.03)
        self.near.registerCallback(self.on_three, "fused")
        self.exact = message_filters.TimeSynchronizer([imu, heat], 20)
        self.exact.registerCallback(self.on_exact)
        self.out = self.create_publisher(PointStamped, "fused", 10)
        self.threes = 0
        self.pairs = 0
        self.worst = 0
        self.create_timer(3.05, self.report)

    def on_three(self, imu, sonar, heat, label):
        stamps = [rclpy.time.Time.from_msg(each.header.stamp).nanoseconds for each in (imu, sonar, heat)]
        self.worst = max(self.worst, max(stamps) - min(stamps))
        self.threes += 1
        self.out.publish(PointStamped(header=heat.header))
        assert label == "fused"

    def on_exact(self, imu, heat):
        assert imu.header.stamp == heat.header.stamp
        self.pairs += 1

    def report(self):
        now = self.get_clock().now()
        before = self.cache.getElemBeforeTime(now - Duration(seconds=1.0))
        after = self.cache.getElemAfterTime(now - Duration(seconds=1.0))
        span = self.cache.getInterval(now - Duration(seconds=1.0), now)
        gap = rclpy.time.Time.from_msg(after.header.stamp) - rclpy.time.Time.from_msg(before.header.stamp)
        self.get_logger().info(
            f"threes {self.threes} worst {self.worst / 1e9:.3f} pairs {self.pairs} "
            f"gap {gap.nanoseconds / 1e9:.3f} in a second {len(span)}"
        )
        raise SystemExit


def main():
    rclpy.init()
    executor = rclpy.executors.SingleThreadedExecutor()
    for node in (Sensors(), Fusion()):
        executor.add_node(node)
    try:
        executor.spin()
    except SystemExit:
        rclpy.logging.get_logger("fusion").info("done")


if __name__ == "__main__":
    main()
