import threading
import math

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from geometry_msgs.msg import Twist


def spin(node):
    try:
        rclpy.spin(node)
    except ExternalShutdownException:
        pass


def main():
    rclpy.init()
    node = Node('half_circle')
    thread = threading.Thread(target=spin, args=(node,), daemon=True)
    thread.start()

    pub = node.create_publisher(Twist, 'cmd_vel', 10)
    rate = node.create_rate(20)

    radius = 1.0
    speed = 0.4
    twist = Twist()
    twist.linear.x = speed
    twist.angular.z = speed / radius

    # let discovery happen
    for _ in range(20):
        rate.sleep()

    ticks = int(20 * math.pi * radius / speed)
    node.get_logger().info(f'{ticks} ticks')
    while rclpy.ok() and ticks > 0:
        pub.publish(twist)
        ticks -= 1
        rate.sleep()

    pub.publish(Twist())
    rate.sleep()
    pub.publish(Twist())
    rate.sleep()
    node.get_logger().info('half circle done')
    rclpy.shutdown()
    thread.join()


if __name__ == '__main__':
    main()
