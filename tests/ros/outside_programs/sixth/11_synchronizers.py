"""message_filters: exact and approximate time, a cache, in one process with its own publishers."""
import message_filters
import rclpy
from rclpy.duration import Duration
from rclpy.node import Node
from sensor_msgs.msg import Image, Imu, Temperature


class N(Node):
    def __init__(self):
        super().__init__("filters")
        self.p = [self.create_publisher(Temperature, "temp", 10), self.create_publisher(Imu, "imu", 10), self.create_publisher(Image, "image", 10)]
        t = message_filters.Subscriber(self, Temperature, "temp")
        i = message_filters.Subscriber(self, Imu, "imu")
        im = message_filters.Subscriber(self, Image, "image")
        self.exact = message_filters.TimeSynchronizer([t, i], 10)
        self.exact.registerCallback(self.on_exact)
        self.near = message_filters.ApproximateTimeSynchronizer([t, im], queue_size=10, slop=0.03)
        self.near.registerCallback(self.on_near)
        self.cache = message_filters.Cache(t, 5)
        self.e = self.a = self.n = 0
        self.create_timer(0.1, self.tick)

    def on_exact(self, t, i):
        assert t.header.stamp == i.header.stamp
        self.e += 1

    def on_near(self, t, im):
        self.a += 1

    def tick(self):
        self.n += 1
        if self.n > 20:
            if self.n == 23:
                self.get_logger().info(f"exact {self.e} near {self.a} cache {len(self.cache.getInterval(self.cache.getOldestTime(), self.cache.getLatestTime()))}")
                rclpy.shutdown()
            return
        now = self.get_clock().now()
        t = Temperature(temperature=20.0 + self.n)
        t.header.stamp = now.to_msg()
        self.p[0].publish(t)
        if self.n % 2 == 0:
            i = Imu()
            i.header.stamp = now.to_msg()
            self.p[1].publish(i)
        im = Image(height=1, width=1, encoding="mono8", step=1, data=[self.n])
        im.header.stamp = (now + Duration(nanoseconds=(20 if self.n % 4 else 60) * 1_000_000)).to_msg()
        self.p[2].publish(im)


rclpy.init()
try:
    rclpy.spin(N())
except rclpy.executors.ExternalShutdownException:
    pass
