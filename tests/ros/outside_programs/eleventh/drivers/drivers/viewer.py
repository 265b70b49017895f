import sys

import rclpy
from rclpy.wait_for_message import wait_for_message
from std_msgs.msg import Int32


def main():
    rclpy.init()
    node = rclpy.create_node('viewer')
    seen = 0
    while seen < 10:
        found, message = wait_for_message(Int32, node, 'image_count', time_to_wait=2.0)
        if not found:
            sys.exit('nothing comes')
        seen += 1
    print('viewer saw', seen)
    rclpy.shutdown()
