"""Dois nós: um watcher que olha, e um driver que conduz. Só os liga o
tópico wall_ahead.

watcher: ouve o laser (static_laser, LaserScan), diz em wall_ahead (Bool)
         se há uma parede a menos de 0.5 m em frente
driver:  ouve wall_ahead, comanda as rodas (cmd_vel, Twist): 0.4 m/s em
         frente, ou 1.0 rad/s à esquerda se há parede
"""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool


class Watcher(Node):
    def __init__(self):
        super().__init__("watcher")
        # TODO


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        # TODO


def main(args=None):
    rclpy.init(args=args)
    # rclpy.spin faz correr um só nó; um executor, vários
    executor = SingleThreadedExecutor()
    executor.add_node(Watcher())
    # TODO: o driver também
    executor.spin()


if __name__ == "__main__":
    main()
