import sys

import message_filters
import rclpy
from message_filters import ApproximateTimeSynchronizer, Cache, SimpleFilter, Subscriber, TimeSynchronizer
from rclpy.clock import ClockType
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import CameraInfo, Image, Imu, LaserScan


# Its name was corrected in a later version.
LATEST = 'getLatestTime' if hasattr(Cache, 'getLatestTime') else 'getLastestTime'


def at(value):
    return Time(seconds=value, clock_type=ClockType.ROS_TIME)


def seconds(stamp):
    return round(stamp.sec + stamp.nanosec * 1e-9, 3)


class EverySecond(SimpleFilter):
    """A filter of one's own, chained behind a subscriber."""

    def __init__(self, f):
        SimpleFilter.__init__(self)
        self.count = self.dropped = 0
        self.connectInput(f)

    def connectInput(self, f):
        self.incoming_connection = f.registerCallback(self.add)

    def add(self, msg):
        self.count += 1
        if self.count % 2:
            self.signalMessage(msg)
        else:
            self.dropped += 1


class Filters(Node):
    def __init__(self):
        super().__init__('filters')
        self.image_sub = Subscriber(self, Image, 'image')
        self.info_sub = Subscriber(self, CameraInfo, 'camera_info', qos_profile=10)
        self.scan_sub = Subscriber(self, LaserScan, 'scan')
        self.imu_sub = message_filters.Subscriber(self, Imu, 'imu')
        self.thinned = EverySecond(self.image_sub)
        self.triples = self.pairs = 0
        self.approximate = ApproximateTimeSynchronizer([self.thinned, self.scan_sub, self.imu_sub], 10, slop=0.03)
        self.approximate.registerCallback(self.on_triple, 'extra')
        self.exact = TimeSynchronizer([self.image_sub, self.info_sub], queue_size=10)
        self.exact.registerCallback(self.on_pair)
        self.cache = Cache(self.scan_sub, 5)
        self.pubs = {name: self.create_publisher(kind, name, 10) for name, kind in (
            ('image', Image), ('camera_info', CameraInfo), ('scan', LaserScan), ('imu', Imu))}
        self.step = 0
        self.timer = self.create_timer(0.05, self.publish)

    def publish(self):
        base = Time(seconds=self.step // 10, nanoseconds=self.step % 10 * 100_000_000)
        offsets = {'image': 0, 'camera_info': 0 if self.step % 2 == 0 else 0.001, 'scan': 0, 'imu': 0.01}
        for name, late in offsets.items():
            message = self.pubs[name].msg_type()
            message.header.stamp = (base + Duration(seconds=late)).to_msg()
            message.header.frame_id = name
            self.pubs[name].publish(message)
        self.step += 1
        if self.step == 20:
            self.timer.cancel()
            self.create_timer(0.5, self.report)

    def on_triple(self, image, scan, imu, word):
        assert seconds(image.header.stamp) == seconds(scan.header.stamp)
        if self.triples % 2 == 0:
            print(f"triple {2 * self.triples} {word} imu {seconds(imu.header.stamp)}")
        self.triples += 1

    def on_pair(self, image, info):
        assert image.header.stamp == info.header.stamp
        self.pairs += 1

    def report(self):
        print('exact pairs', self.pairs)
        oldest, newest = self.cache.getOldestTime(), getattr(self.cache, LATEST)()
        print('cache of 5: oldest', oldest.nanoseconds / 1e9, 'newest', newest.nanoseconds / 1e9)
        found = self.cache.getInterval(at(1.6), at(1.8))
        print('between:', [seconds(each.header.stamp) for each in found])
        before = self.cache.getElemBeforeTime(at(1.65))
        after = self.cache.getElemAfterTime(at(1.65))
        print(f'before 1.65: {seconds(before.header.stamp)}, after: {seconds(after.header.stamp)}')
        print('dropped', self.thinned.dropped)
        sys.exit(0)


rclpy.init()
rclpy.spin(Filters())
