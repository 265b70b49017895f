import rclpy
from rclpy.node import Node
from std_msgs.msg import Int32


class Carrier(Node):
    def __init__(self):
        super().__init__('carrier')
        self.declare_parameter('period', 2.0)
        self.declare_parameter('load', 0)
        self.pub = self.create_publisher(Int32, 'carried', 10)
        self.create_timer(self.get_parameter('period').value, self.carry)
        self.get_logger().info(f'{self.get_fully_qualified_name()} carries {self.get_parameter("load").value}'
                               f' on {self.pub.topic_name}')

    def carry(self):
        self.pub.publish(Int32(data=self.get_parameter('load').value))


def main():
    rclpy.init()
    node = Carrier()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
