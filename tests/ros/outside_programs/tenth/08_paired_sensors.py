"""message_filters: three topics by approximate time, a cache, a chain, and one pair by exact time.

Meant: a camera at 10 Hz, its info with the same stamps, an IMU at 25 Hz with a delay; the exact
pair fires for each picture that has an info (every third info is lost), the approximate one for each
picture, and the cache answers which IMU messages lie in a span.
"""
import rclpy
from message_filters import ApproximateTimeSynchronizer, Cache, Subscriber, TimeSynchronizer
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import CameraInfo, Image, Imu


class Rig(Node):
    def __init__(self):
        super().__init__('rig')
        self.image = self.create_publisher(Image, 'image', 10)
        self.info = self.create_publisher(CameraInfo, 'info', 10)
        self.imu = self.create_publisher(Imu, 'imu', 10)
        self.pictures = self.measures = 0
        self.create_timer(0.1, self.shoot)
        self.create_timer(0.04, self.shake)

    def shoot(self):
        if self.pictures >= 30:
            return
        stamp = self.get_clock().now().to_msg()
        image = Image(height=2, width=2, encoding='mono8', step=2, data=[0, 1, 2, 3])
        image.header.stamp = stamp
        image.header.frame_id = str(self.pictures)
        self.image.publish(image)
        if self.pictures % 3 != 2:
            info = CameraInfo(height=2, width=2)
            info.header.stamp = stamp
            self.info.publish(info)
        self.pictures += 1

    def shake(self):
        imu = Imu()
        imu.header.stamp = (self.get_clock().now() - Duration(nanoseconds=5_000_000)).to_msg()
        imu.angular_velocity.z = float(self.measures)
        self.measures += 1
        self.imu.publish(imu)


class Fusion(Node):
    def __init__(self):
        super().__init__('fusion')
        image = Subscriber(self, Image, 'image')
        info = Subscriber(self, CameraInfo, 'info', qos_profile=10)
        imu = Subscriber(self, Imu, 'imu')
        self.exact = TimeSynchronizer([image, info], 10)
        self.exact.registerCallback(self.on_pair, 'pair')
        self.approximate = ApproximateTimeSynchronizer([image, imu], queue_size=20, slop=0.03)
        self.approximate.registerCallback(self.on_both)
        self.cache = Cache(imu, cache_size=100)
        self.pairs, self.both, self.gaps, self.raw = [], 0, [], 0
        image.registerCallback(self.on_image)

    def on_image(self, _image):
        self.raw += 1

    def on_pair(self, image, info, word):
        assert word == 'pair' and image.header.stamp == info.header.stamp
        self.pairs.append(int(image.header.frame_id))

    def on_both(self, image, imu):
        gap = Time.from_msg(image.header.stamp) - Time.from_msg(imu.header.stamp)
        self.gaps.append(abs(gap.nanoseconds))
        self.both += 1


def main():
    rclpy.init()
    rig, fusion = Rig(), Fusion()
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(rig)
    executor.add_node(fusion)
    start = rig.get_clock().now()
    while (rig.get_clock().now() - start) < Duration(seconds=4):
        executor.spin_once(timeout_sec=0.05)
    print('raw', fusion.raw, 'exact', len(fusion.pairs), 'lost ones', [n for n in fusion.pairs if n % 3 == 2])
    print('approximate', fusion.both == 30, 'gaps small', max(fusion.gaps) <= 30_000_000)
    newest = fusion.cache.getLastestTime() if hasattr(fusion.cache, 'getLastestTime') else fusion.cache.getLatestTime()
    span = fusion.cache.getInterval(newest - Duration(seconds=1), newest)
    print('one second of imu', len(span) in (25, 26), 'ordered',
          [m.angular_velocity.z for m in span] == sorted(m.angular_velocity.z for m in span))
    print('before', fusion.cache.getElemBeforeTime(newest - Duration(seconds=0.5)) is not None)
    rclpy.shutdown()


main()
