"""Conduz um quadrado: um metro em frente, um quarto de volta para a
esquerda, e assim por diante, quatro vezes.

Já anda, mas não faz um quadrado. Dois dos quatro números abaixo estão
errados.
"""

import math  # math.pi é meia volta

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node

SPEED = 0.4  # m/s, num lado
TURN_RATE = 0.8  # rad/s para a esquerda, num canto

SIDE_TIME = 1.0  # s. TODO: quanto tempo demora um metro a SPEED?
# s. TODO: quanto tempo demora um quarto de volta a TURN_RATE?
CORNER_TIME = 1.0


class Square(Node):
    def __init__(self):
        super().__init__("square")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.done = 0  # lados e cantos já feitos
        self.timer = self.create_timer(0.1, self.go_on)

    def go_on(self):
        """Começa o lado ou o canto seguinte, e volta aqui quando acabar.
        """
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
