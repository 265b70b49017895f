"""Parameters: descriptor with range, validation, post-set, describe, undeclare, events."""
import rclpy
from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor, ParameterEvent, SetParametersResult
from rclpy.exceptions import InvalidParameterValueException, ParameterNotDeclaredException
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.parameter_event_handler import ParameterEventHandler


class P(Node):
    def __init__(self):
        super().__init__("param_node")
        self.declare_parameter("speed", 0.5, ParameterDescriptor(
            description="m/s", floating_point_range=[FloatingPointRange(from_value=0.0, to_value=1.0, step=0.0)]))
        self.declare_parameter("count", 3, ParameterDescriptor(integer_range=[IntegerRange(from_value=0, to_value=10, step=1)]))
        self.declare_parameter("name", "robot")
        self.declare_parameter("fixed", True, ParameterDescriptor(read_only=True))
        self.declare_parameter("list", [1.0, 2.0])
        self.add_on_set_parameters_callback(self.check)
        self.add_post_set_parameters_callback(self.after)
        self.handler = ParameterEventHandler(self)
        self.h = self.handler.add_parameter_callback("name", "param_node", self.changed)
        self.create_timer(0.5, self.step)
        self.n = 0

    def check(self, params):
        for p in params:
            if p.name == "name" and not p.value:
                return SetParametersResult(successful=False, reason="a name is needed")
        return SetParametersResult(successful=True)

    def after(self, params):
        print("after", [(p.name, p.value) for p in params])

    def changed(self, p):
        print("event", p.name, p.value.string_value)

    def step(self):
        self.n += 1
        if self.n == 1:
            print([r.successful for r in self.set_parameters([Parameter("speed", value=0.7), Parameter("speed", value=1.5)])])
            print(self.set_parameters_atomically([Parameter("name", value=""), Parameter("count", value=4)]).reason)
            print(self.get_parameter("count").value)
            print([r.successful for r in self.set_parameters([Parameter("fixed", value=False)])])
            self.set_parameters([Parameter("name", Parameter.Type.STRING, "burger")])
            try:
                self.get_parameter("nothing")
            except ParameterNotDeclaredException as e:
                print(type(e).__name__)
            print(self.get_parameter_or("nothing", Parameter("nothing", value=9)).value)
            print(self.describe_parameter("speed").description, self.has_parameter("list"), list(self.get_parameter("list").value))
            self.undeclare_parameter("list")
            print(self.has_parameter("list"))
        elif self.n == 2:
            self.destroy_node()
            rclpy.shutdown()


rclpy.init()
n = P()
try:
    rclpy.spin(n)
except rclpy.executors.ExternalShutdownException:
    pass
print("end")
