import argparse

import rclpy
from rclpy.utilities import remove_ros_args
from std_msgs.msg import Float64


def main(args=None):
    parser = argparse.ArgumentParser(description='waits until the oven is hot')
    parser.add_argument('--dish', required=True)
    rclpy.init(args=args)
    chosen = parser.parse_args(remove_ros_args()[1:])
    node = rclpy.create_node('cook')
    hot = rclpy.task.Future()

    def on_heat(message):
        if message.data >= 60.0 and not hot.done():
            hot.set_result(message.data)

    node.create_subscription(Float64, 'heat', on_heat, 10)
    rclpy.spin_until_future_complete(node, hot)
    node.get_logger().info(f'{chosen.dish} cooked at {hot.result()} by {node.get_fully_qualified_name()}')
    node.destroy_node()
    rclpy.shutdown()
