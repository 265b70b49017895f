"""Talks, reliably or not, as the command line says."""

import argparse
import sys

import rclpy
from example_interfaces.msg import String
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import QoSProfile, QoSReliabilityPolicy, qos_profile_sensor_data
from rclpy.utilities import remove_ros_args


class TalkerQos(Node):
    def __init__(self, qos_profile):
        super().__init__("talker_qos")
        self.i = 0
        if qos_profile.reliability is QoSReliabilityPolicy.RELIABLE:
            self.get_logger().info("Reliable talker")
        else:
            self.get_logger().info("Best effort talker")
        self.pub = self.create_publisher(String, "chatter", qos_profile)
        self.tmr = self.create_timer(1.0, self.timer_callback)

    def timer_callback(self):
        msg = String()
        msg.data = "Hello World: {0}".format(self.i)
        self.i += 1
        self.get_logger().info('Publishing: "{0}"'.format(msg.data))
        self.pub.publish(msg)


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
            node = TalkerQos(profile)
            cycle_count = 0
            while rclpy.ok() and cycle_count < args.number_of_cycles:
                rclpy.spin_once(node)
                cycle_count += 1
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
