#!/usr/bin/env python3
from dataclasses import dataclass, field
from functools import partial
from typing import Dict, Optional

import rclpy
from rclpy.node import Node
from rclpy.time import Time
from geometry_msgs.msg import Twist
from std_msgs.msg import String


@dataclass
class Source:
    name: str
    priority: int
    timeout: float
    msg: Twist = field(default_factory=Twist)
    stamp: Optional[Time] = None

    def alive(self, now: Time) -> bool:
        return self.stamp is not None and (now - self.stamp).nanoseconds < self.timeout * 1e9


class Mux(Node):
    def __init__(self) -> None:
        super().__init__('cmd_vel_mux')
        self.sources: Dict[str, Source] = {}
        for s in (Source('nav', 1, 0.5), Source('joystick', 10, 0.5)):
            self.sources[s.name] = s
            self.create_subscription(Twist, f'{s.name}/cmd_vel', partial(self.incoming, s), 10)
        self.active = 'idle'
        self.out = self.create_publisher(Twist, 'cmd_vel', 10)
        self.who = self.create_publisher(String, 'mux/active', 10)
        self.create_timer(0.05, self.select)

    def incoming(self, source: Source, msg: Twist) -> None:
        source.msg, source.stamp = msg, self.get_clock().now()

    def select(self) -> None:
        now = self.get_clock().now()
        best = max((s for s in self.sources.values() if s.alive(now)), key=lambda s: s.priority, default=None)
        name = best.name if best else 'idle'
        if name != self.active:
            self.get_logger().info(f'{self.active} => {name}')
            self.who.publish(String(data=name))
            self.active = name
        self.out.publish(best.msg if best else Twist())


def main() -> None:
    rclpy.init()
    rclpy.spin(Mux())


if __name__ == '__main__':
    main()
