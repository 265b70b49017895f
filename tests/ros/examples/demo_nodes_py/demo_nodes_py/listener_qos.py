"""Listens, reliably or not, as the command line says."""

import argparse
import sys

import rclpy
from example_interfaces.msg import String
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import QoSProfile, QoSReliabilityPolicy, qos_profile_sensor_data
from rclpy.utilities import remove_ros_args


class ListenerQos(Node):
    def __init__(self, qos_profile):
        super().__init__("listener_qos")
        if qos_profile.reliability is QoSReliabilityPolicy.RELIABLE:
            self.get_logger().info("Reliable listener")
        else:
            self.get_logger().info("Best effort listener")
        self.sub = self.create_subscription(String, "chatter", self.chatter_callback, qos_profile)

    def chatter_callback(self, msg):
        self.get_logger().info("I heard: [%s]" % msg.data)


def main(argv=sys.argv[1:]):
    parser = argparse.ArgumentParser()
    parser.add_argument("--reliable", action="store_true")
    parser.add_argument("-n", "--number_of_cycles", type=int, default=20)
    args = parser.parse_args(remove_ros_args(args=argv))
    try:
        with rclpy.init(args=argv):
            if args.reliable:
                profile = QoSProfile(depth=10, reliability=QoSReliabilityPolicy.RELIABLE)
            else:
                profile = qos_profile_sensor_data
            node = ListenerQos(profile)
            cycle_count = 0
            while rclpy.ok() and cycle_count < args.number_of_cycles:
                rclpy.spin_once(node)
                cycle_count += 1
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
