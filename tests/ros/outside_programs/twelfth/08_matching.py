"""message_filters in a row: subscribers, a filter of one's own, exact and approximate matching, a cache of intervals, a chain."""
import rclpy
from geometry_msgs.msg import PointStamped
from message_filters import ApproximateTimeSynchronizer, Cache, SimpleFilter, Subscriber, TimeSynchronizer
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.time import Time
from sensor_msgs.msg import Range, Temperature
from std_msgs.msg import Int32


class EverySecond(SimpleFilter):
    """Lets every second message through."""

    def __init__(self, source):
        super().__init__()
        self.count = 0
        self.incoming = source.registerCallback(self.add)

    def add(self, message):
        self.count += 1
        if self.count % 2 == 0:
            self.signalMessage(message)


class Sensors(Node):
    def __init__(self):
        super().__init__('sensors')
        self.ranges = self.create_publisher(Range, 'range', qos_profile_sensor_data)
        self.temperatures = self.create_publisher(Temperature, 'temperature', 10)
        self.points = self.create_publisher(PointStamped, 'point', 10)
        self.counts = self.create_publisher(Int32, 'count', 10)
        self.number = 0
        self.create_timer(0.1, self.tick)

    def tick(self):
        self.number += 1
        if self.number > 20:
            return
        now = self.get_clock().now()
        message = Range(range=float(self.number))
        message.header.stamp = now.to_msg()
        self.ranges.publish(message)
        late = Temperature(temperature=float(self.number))
        late.header.stamp = (now + Duration(nanoseconds=30_000_000)).to_msg()
        self.temperatures.publish(late)
        if self.number % 4 == 0:
            exact = PointStamped()
            exact.point.x = float(self.number)
            exact.header.stamp = now.to_msg()
            self.points.publish(exact)
        self.counts.publish(Int32(data=self.number))


class Matcher(Node):
    def __init__(self):
        super().__init__('matcher')
        ranges = Subscriber(self, Range, 'range', qos_profile=qos_profile_sensor_data)
        temperatures = Subscriber(self, Temperature, 'temperature')
        points = Subscriber(self, PointStamped, 'point')
        counts = Subscriber(self, Int32, 'count')
        self.near, self.exact, self.tight, self.chained, self.headerless, self.called = [], [], [], [], [], []
        ApproximateTimeSynchronizer([ranges, temperatures], 10, 0.05).registerCallback(self.on_near)
        ApproximateTimeSynchronizer([ranges, temperatures], 10, 0.01).registerCallback(
            lambda *pair: self.tight.append(pair))
        TimeSynchronizer([ranges, points], queue_size=10).registerCallback(self.on_exact)
        half = EverySecond(ranges)
        half.registerCallback(lambda message, name: self.chained.append((name, message.range)), 'half')
        self.matched = ApproximateTimeSynchronizer([counts, ranges], 10, 0.06, allow_headerless=True)
        self.matched.registerCallback(lambda count, message: self.headerless.append(count.data - int(message.range)))
        self.cache = Cache(ranges, 8)
        self.newest = Cache(half, 2)
        self.counts = counts

    def on_near(self, message, temperature):
        self.near.append((message.range, temperature.temperature))

    def on_exact(self, message, point):
        self.exact.append((message.range, point.point.x))


def main():
    rclpy.init()
    sensors, matcher = Sensors(), Matcher()
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(sensors)
    executor.add_node(matcher)
    begun = sensors.get_clock().now()
    while sensors.get_clock().now() - begun < Duration(seconds=2.5):
        executor.spin_once(timeout_sec=0.1)
    print('near', len(matcher.near), matcher.near[0], all(a == b for a, b in matcher.near))
    print('tight', len(matcher.tight))
    print('exact', matcher.exact)
    print('chained', matcher.chained[:3], len(matcher.chained))
    print('headerless', len(matcher.headerless) >= 18, set(matcher.headerless) <= {-1, 0, 1})
    oldest, latest = matcher.cache.getOldestTime(), matcher.cache.getLastestTime() if hasattr(
        matcher.cache, 'getLastestTime') else matcher.cache.getLatestTime()
    print(f'cache {(latest - oldest).nanoseconds / 1e9:.1f}', matcher.cache.getLast().range)
    middle = oldest + Duration(seconds=0.25)
    print('interval', [each.range for each in matcher.cache.getInterval(oldest, middle)])
    print('around', matcher.cache.getElemBeforeTime(middle).range, matcher.cache.getElemAfterTime(middle).range)
    print('before all', matcher.cache.getElemBeforeTime(Time(nanoseconds=1, clock_type=middle.clock_type)))
    print('newest', matcher.newest.getLast().range)
    print('topics', matcher.counts.getTopic() if hasattr(matcher.counts, 'getTopic') else matcher.counts.topic)
    rclpy.shutdown()


if __name__ == '__main__':
    main()
