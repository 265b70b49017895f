import queue
import threading

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class ScanReader(Node):
    def __init__(self, inbox):
        super().__init__("scan_reader")
        self.inbox = inbox
        self.create_subscription(LaserScan, "scan", self.inbox.put, 10)
        self.pub = self.create_publisher(Twist, "cmd_vel", 10)


def main():
    rclpy.init()
    inbox = queue.Queue()
    node = ScanReader(inbox)
    spinner = threading.Thread(target=rclpy.spin, args=(node,), daemon=True)
    spinner.start()

    seen, idle = 0, 0
    command = Twist()
    command.linear.x = 0.25
    while rclpy.ok():
        try:
            scan = inbox.get_nowait()
        except queue.Empty:
            idle += 1
            continue
        seen += 1
        ahead = scan.ranges[0]
        if ahead < 3.5:
            break
        node.pub.publish(command)
    node.pub.publish(Twist())
    print(f"stopped {ahead:.1f} m before the wall after {seen} scans")
    print("polled in between:", idle > 0)
    rclpy.shutdown()
    spinner.join()


if __name__ == "__main__":
    main()
