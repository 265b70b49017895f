import math

import rclpy
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import IntegerRange, ParameterDescriptor, SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter


class Polygon(Node):
    def __init__(self):
        super().__init__("polygon")
        self.declare_parameter(
            "sides", 3,
            ParameterDescriptor(description="number of sides", integer_range=[IntegerRange(from_value=3, to_value=8, step=1)]),
        )
        self.declare_parameters("", [("side", 1.5), ("speed", 1.0)])
        self.add_pre_set_parameters_callback(self.before)
        self.add_on_set_parameters_callback(self.check)
        self.add_post_set_parameters_callback(self.after)
        self.pub = self.create_publisher(Twist, "turtle1/cmd_vel", 10)
        self.queue = []
        self.plan()
        self.timer = self.create_timer(0.05, self.step)

    def before(self, params):
        for p in params:
            if p.name == "side" and p.value == 2:
                return [Parameter("side", value=2.0)]
        return params

    def check(self, params):
        for p in params:
            if p.name == "speed" and p.value > 2.0:
                return SetParametersResult(successful=False, reason="too fast")
        return SetParametersResult(successful=True)

    def after(self, params):
        self.get_logger().info("now " + ", ".join(f"{p.name}={p.value}" for p in params))

    def plan(self):
        sides = self.get_parameter("sides").value
        side, speed = (self.get_parameter(n).value for n in ("side", "speed"))
        for _ in range(sides):
            self.queue += [(speed, 0.0)] * round(side / speed / 0.05)
            self.queue += [(0.0, 2 * math.pi / sides / 1.0)] * 20
        self.queue.append((0.0, 0.0))

    def step(self):
        if not self.queue:
            self.timer.cancel()
            self.next_one()
            return
        linear, angular = self.queue.pop(0)
        msg = Twist()
        msg.linear.x, msg.angular.z = linear, angular
        self.pub.publish(msg)

    def next_one(self):
        sides = self.get_parameter("sides").value
        self.get_logger().info(f"polygon of {sides} drawn")
        if sides == 5:
            rclpy.shutdown()
            return
        print([r.successful for r in self.set_parameters([
            Parameter("speed", Parameter.Type.DOUBLE, 5.0), Parameter("sides", Parameter.Type.INTEGER, 9)])])
        print(self.set_parameters_atomically([Parameter("speed", value=3.0), Parameter("sides", value=4)]).reason)
        self.set_parameters([Parameter("sides", value=5)])
        self.plan()
        self.timer.reset()


rclpy.init()
node = Polygon()
rclpy.spin(node)
print("finished")
