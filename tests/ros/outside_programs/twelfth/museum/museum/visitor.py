import rclpy
from rclpy.node import Node
from std_msgs.msg import String


def main():
    rclpy.init()
    node = Node('visitor')
    number = node.declare_parameter('number', 0).value
    heard = set()
    node.create_subscription(String, '/siren', lambda message: heard.add(message.data), 10)
    end = node.get_clock().now() + rclpy.duration.Duration(seconds=3)
    while rclpy.ok() and node.get_clock().now() < end:
        rclpy.spin_once(node, timeout_sec=0.2)
    print(f'{node.get_name()} number {number} heard {sorted(heard)}', flush=True)
    node.destroy_node()
    rclpy.shutdown()
