"""Drive a square: one metre ahead, a quarter turn to the left, and so
on, four times.

It drives already, but no square. Two of the four numbers below are
wrong.
"""

import math  # math.pi is half a turn

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node

SPEED = 0.4  # m/s, on a side
TURN_RATE = 0.8  # rad/s to the left, in a corner

SIDE_TIME = 1.0  # s. TODO: how long does one metre take at SPEED?
# s. TODO: how long does a quarter turn take at TURN_RATE?
CORNER_TIME = 1.0


class Square(Node):
    def __init__(self):
        super().__init__("square")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.done = 0  # sides and corners so far
        self.timer = self.create_timer(0.1, self.go_on)

    def go_on(self):
        """Begin the next side or corner, and come back here when it is
        over."""
        self.timer.cancel()
        command = Twist()
        if self.done < 8:
            is_side = self.done % 2 == 0
            if is_side:
                command.linear.x = SPEED
            else:
                command.angular.z = TURN_RATE
            self.done += 1
            self.timer = self.create_timer(SIDE_TIME if is_side else CORNER_TIME, self.go_on)
        self.drive.publish(command)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Square())


if __name__ == "__main__":
    main()
