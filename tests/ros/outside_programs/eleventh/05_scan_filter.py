#!/usr/bin/env python3
import copy
import math
from functools import partial

import numpy as np
import rclpy
from rclpy.node import Node
from rclpy.qos import QoSPresetProfiles, qos_profile_sensor_data
from sensor_msgs.msg import LaserScan, Range


def median_filter(values: np.ndarray, width: int = 5) -> np.ndarray:
    half = width // 2
    padded = np.concatenate([values[-half:], values, values[:half]])
    return np.median(np.lib.stride_tricks.sliding_window_view(padded, width), axis=1)


class ScanFilter(Node):

    def __init__(self):
        super().__init__('scan_filter')
        self.step = self.declare_parameter('step', 10).value
        self.clip = self.declare_parameter('clip', 7.5).value
        self.publisher_ = self.create_publisher(
            LaserScan, 'scan_filtered', QoSPresetProfiles.get_from_short_key('sensor_data'))
        self.closest = self.create_publisher(Range, 'closest', 10)
        self.subscription = self.create_subscription(LaserScan, 'scan', self.on_scan, qos_profile_sensor_data)
        self.check = self.create_subscription(
            LaserScan, 'scan_filtered', partial(self.on_filtered, 'filtered'), qos_profile_sensor_data)

    def on_scan(self, msg: LaserScan):
        ranges = np.array(msg.ranges, dtype=np.float32)
        spoiled = ranges.copy()
        spoiled[45] = 0.1  # one bad ray
        clean = median_filter(np.nan_to_num(spoiled, posinf=msg.range_max))
        self.get_logger().info(f'noise removed: {abs(clean[45] - ranges[45]) < 0.5}', once=True)
        clean = np.clip(clean, msg.range_min, self.clip)
        out = copy.deepcopy(msg)
        out.ranges = clean[::self.step].tolist()
        out.angle_increment = msg.angle_increment * self.step
        out.intensities = []
        out.range_max = self.clip
        self.publisher_.publish(out)
        near = Range(header=msg.header, radiation_type=Range.INFRARED, field_of_view=2 * math.pi)
        near.min_range, near.max_range = msg.range_min, msg.range_max
        near.range = float(clean.min())
        self.closest.publish(near)
        self.get_logger().info(f'{len(out.ranges)} of {len(msg.ranges)} rays', throttle_duration_sec=2.0)

    def on_filtered(self, name, msg):
        def ray(degrees):
            index = round((math.radians(degrees) - msg.angle_min) / msg.angle_increment) % len(msg.ranges)
            return f'{msg.ranges[index]:.1f}'
        self.get_logger().info(
            f'{name}: front {ray(0)} left {ray(90)} back {ray(180)} right {ray(270)}', throttle_duration_sec=1.0)


def main(args=None):
    rclpy.init(args=args)
    scan_filter = ScanFilter()
    try:
        rclpy.spin(scan_filter)
    except KeyboardInterrupt:
        pass
    finally:
        scan_filter.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
