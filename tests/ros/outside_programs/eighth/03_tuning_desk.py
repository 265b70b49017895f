"""A controller whose gains have ranges, and a desk in another node that turns its knobs by services."""

import rclpy
from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    ParameterEvent,
    ParameterType,
    SetParametersResult,
)
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters, SetParametersAtomically
from rclpy.exceptions import ParameterAlreadyDeclaredException, ParameterNotDeclaredException
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter


class Controller(Node):
    def __init__(self):
        super().__init__("controller")
        gain = ParameterDescriptor(
            description="proportional gain",
            floating_point_range=[FloatingPointRange(from_value=0.0, to_value=2.0, step=0.5)],
        )
        steps = ParameterDescriptor(integer_range=[IntegerRange(from_value=1, to_value=9, step=2)])
        self.declare_parameters(
            "pid",
            [("kp", 1.0, gain), ("steps", 3, steps), ("name", "first")],
        )
        self.declare_parameter("frame", "odom", ParameterDescriptor(read_only=True))
        self.declare_parameter("any", 1, ParameterDescriptor(dynamic_typing=True))
        self.declare_parameter("mirror", "first")
        self.add_pre_set_parameters_callback(self.before)
        self.add_on_set_parameters_callback(self.check)
        self.add_post_set_parameters_callback(self.after)

    def before(self, parameters):
        names = {each.name for each in parameters}
        if "pid.name" in names:
            value = next(each.value for each in parameters if each.name == "pid.name")
            parameters.append(Parameter("mirror", Parameter.Type.STRING, value))
        return parameters

    def check(self, parameters):
        for each in parameters:
            if each.name == "pid.name" and each.value == "bad":
                return SetParametersResult(successful=False, reason="bad names are not welcome")
        return SetParametersResult(successful=True)

    def after(self, parameters):
        self.get_logger().info("now " + ", ".join(f"{each.name}={each.value}" for each in parameters))


class Desk(Node):
    def __init__(self):
        super().__init__("desk")
        self.set_ = self.create_client(SetParameters, "/controller/set_parameters")
        self.atomic = self.create_client(SetParametersAtomically, "/controller/set_parameters_atomically")
        self.get_ = self.create_client(GetParameters, "/controller/get_parameters")
        self.describe = self.create_client(DescribeParameters, "/controller/describe_parameters")
        self.list_ = self.create_client(ListParameters, "/controller/list_parameters")
        self.create_subscription(ParameterEvent, "/parameter_events", self.on_event, 10)
        self.changed = []

    def on_event(self, event):
        if event.node == "/controller":
            self.changed += [each.name for each in event.changed_parameters]


def main():
    rclpy.init()
    controller, desk = Controller(), Desk()
    executor = SingleThreadedExecutor()
    executor.add_node(controller)
    executor.add_node(desk)

    def call(client, request):
        future = client.call_async(request)
        executor.spin_until_future_complete(future, timeout_sec=5.0)
        return future.result()

    def turn(**knobs):
        parameters = [Parameter(name.replace("__", "."), value=value).to_parameter_msg() for name, value in knobs.items()]
        for result in call(desk.set_, SetParameters.Request(parameters=parameters)).results:
            print(f"{list(knobs)}: {result.successful} {result.reason}", flush=True)

    turn(pid__kp=1.5)
    turn(pid__kp=1.3)
    turn(pid__kp=2.5)
    turn(pid__steps=5)
    turn(pid__steps=4)
    turn(pid__kp=1)
    turn(frame="map")
    turn(any="now a text")
    turn(pid__name="second")
    turn(pid__name="bad")
    turn(nobody=1)
    both = [Parameter("pid.kp", value=0.5), Parameter("pid.name", value="bad")]
    result = call(desk.atomic, SetParametersAtomically.Request(parameters=[each.to_parameter_msg() for each in both]))
    print("together:", result.result.successful, result.result.reason)
    values = call(desk.get_, GetParameters.Request(names=["pid.kp", "mirror", "any", "nobody"])).values
    print("values:", values[0].double_value, values[1].string_value, values[2].type == ParameterType.PARAMETER_STRING, len(values))
    told = call(desk.describe, DescribeParameters.Request(names=["pid.kp", "frame"])).descriptors
    print("described:", told[0].description, told[0].floating_point_range[0].step, told[1].read_only)
    listed = call(desk.list_, ListParameters.Request(prefixes=["pid"], depth=0)).result
    print("listed:", sorted(listed.names), list(listed.prefixes))
    try:
        controller.get_parameter("nobody")
    except ParameterNotDeclaredException as error:
        print("caught", error)
    try:
        controller.declare_parameter("frame", "map")
    except ParameterAlreadyDeclaredException:
        print("caught a second declaration")
    print("by prefix:", sorted(controller.get_parameters_by_prefix("pid")))
    print("or:", controller.get_parameter_or("nobody", Parameter("nobody", value=7)).value)
    for _ in range(20):
        executor.spin_once(timeout_sec=0.1)
    print("events:", desk.changed)
    rclpy.shutdown()


if __name__ == "__main__":
    main()
