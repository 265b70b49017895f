#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from rclpy.time import Time
from message_filters import Subscriber, TimeSynchronizer, Cache
from sensor_msgs.msg import Temperature, RelativeHumidity
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue


class Weather(Node):
    def __init__(self):
        super().__init__('weather')
        t = Subscriber(self, Temperature, 'temperature')
        h = Subscriber(self, RelativeHumidity, 'humidity')
        self.sync = TimeSynchronizer([t, h], 10)
        self.sync.registerCallback(self.pair)
        self.cache = Cache(t, 5)
        self.pub = self.create_publisher(DiagnosticArray, 'diagnostics', 10)
        self.pairs = 0

    def pair(self, temp, hum):
        self.pairs += 1
        assert temp.header.stamp == hum.header.stamp
        level = DiagnosticStatus.OK if temp.temperature < 28.0 else DiagnosticStatus.WARN
        st = DiagnosticStatus(level=level, name='weather', message=f'pair {self.pairs}', hardware_id='box')
        st.values = [KeyValue(key='temperature', value='%.1f' % temp.temperature),
                     KeyValue(key='humidity', value='%.2f' % hum.relative_humidity)]
        arr = DiagnosticArray(status=[st])
        arr.header.stamp = self.get_clock().now().to_msg()
        self.pub.publish(arr)
        if level == DiagnosticStatus.WARN:
            self.get_logger().warn(f'hot: {temp.temperature:.1f} with humidity {hum.relative_humidity:.2f}', once=True)
        if self.pairs == 10:
            first = self.cache.getOldestTime()
            last = Time.from_msg(self.cache.getLast().header.stamp)
            self.get_logger().info('cache spans %.1f s' % ((last - first).nanoseconds / 1e9))


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Weather())


if __name__ == '__main__':
    main()
