"""Two nodes of other modules in one executor."""

import rclpy
from rclpy.executors import SingleThreadedExecutor

from examples_rclpy.listener import Listener
from examples_rclpy.talker import Talker


def main(args=None):
    rclpy.init(args=args)
    try:
        talker = Talker()
        listener = Listener()
        executor = SingleThreadedExecutor()
        executor.add_node(talker)
        executor.add_node(listener)
        try:
            executor.spin()
        finally:
            executor.shutdown()
            listener.destroy_node()
            talker.destroy_node()
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
