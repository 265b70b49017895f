import sys
import rclpy
from std_msgs.msg import Int64


def main():
    rclpy.init(args=sys.argv)
    node = rclpy.create_node('count_up')
    pub = node.create_publisher(Int64, 'count', 10)
    n = 0
    def tick():
        nonlocal n
        pub.publish(Int64(data=n))
        print(f'sent {n}', flush=True)
        n += 1
    node.create_timer(0.1, tick)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        print('bye', file=sys.stderr)


main()
