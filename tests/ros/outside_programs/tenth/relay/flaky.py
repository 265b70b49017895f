"""Dies twice with code 3, stays the third time; counts in a file beside its log."""
import os
import pathlib
import sys

import rclpy
from rclpy.node import Node
from std_srvs.srv import Trigger


def main():
    rclpy.init()
    node = Node('flaky')
    counter = pathlib.Path(os.environ['FLAKY_COUNTER'])
    tries = int(counter.read_text()) + 1 if counter.exists() else 1
    counter.write_text(str(tries))
    print(f'try {tries}', flush=True)
    if tries < 3:
        sys.exit(3)
    counter.unlink()

    def serve(_request, response):
        response.success = True
        response.message = f'up after {tries}'
        return response

    node.create_service(Trigger, 'are_you_up', serve)
    print('READY', flush=True)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        print('flaky leaves', flush=True)


if __name__ == '__main__':
    main()
