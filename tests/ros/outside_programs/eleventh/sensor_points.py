import math
import sys

import message_filters
import numpy as np
import rclpy
from geometry_msgs.msg import PointStamped

POINTS = [(18.0, 12.0), (1.0, -7.0), (-12.0, 7.0), (-5.0, -15.0)]


def transform(x, y, theta):
    c, s = math.cos(theta), math.sin(theta)
    return np.array([[c, -s, x], [s, c, y], [0, 0, 1]])


def main():
    rclpy.init(args=sys.argv)
    node = rclpy.create_node('sensor_points')
    pub = node.create_publisher(PointStamped, 'sensor_coord', 10)
    agreed = []

    def compare(robot, world):
        index = len(agreed)
        by_hand = transform(5, 3, math.radians(135)) @ transform(-1, 0, math.pi) @ np.array([*POINTS[index], 1.0])
        print(f'robot {robot.point.x:.2f} {robot.point.y:.2f} world {world.point.x:.2f} {world.point.y:.2f}')
        agreed.append(np.allclose(by_hand[:2], [world.point.x, world.point.y], atol=1e-6))

    both = message_filters.TimeSynchronizer([
        message_filters.Subscriber(node, PointStamped, 'robot_coord'),
        message_filters.Subscriber(node, PointStamped, 'world_coord')], 10)
    both.registerCallback(compare)
    while node.count_subscribers('sensor_coord') == 0 or node.count_publishers('world_coord') == 0:
        rclpy.spin_once(node, timeout_sec=0.1)
    for index, (x, y) in enumerate(POINTS):
        msg = PointStamped()
        msg.header.frame_id = 'sensor'
        msg.header.stamp = node.get_clock().now().to_msg()
        msg.point.x, msg.point.y = x, y
        pub.publish(msg)
        while len(agreed) == index:
            rclpy.spin_once(node)
    print('by hand agrees:', sum(agreed), 'of', len(agreed))
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
