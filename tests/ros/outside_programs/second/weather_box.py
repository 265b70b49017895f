#!/usr/bin/env python3
# temperature each 0.25 s, humidity with the same stamp only each second time
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import Temperature, RelativeHumidity


class Box(Node):
    def __init__(self):
        super().__init__('box')
        self.t = self.create_publisher(Temperature, 'temperature', 10)
        self.h = self.create_publisher(RelativeHumidity, 'humidity', 10)
        self.k = 0
        self.create_timer(0.25, self.tick)

    def tick(self):
        stamp = self.get_clock().now().to_msg()
        m = Temperature()
        m.header.stamp = stamp
        m.temperature = 20.0 + 0.5 * self.k
        self.t.publish(m)
        if self.k % 2 == 0:
            h = RelativeHumidity()
            h.header.stamp = stamp
            h.relative_humidity = 0.4
            self.h.publish(h)
        self.k += 1


rclpy.init()
rclpy.spin(Box())
