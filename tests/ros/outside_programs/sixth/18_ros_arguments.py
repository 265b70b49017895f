"""Remap and parameters from the command line in the program, a relative service, get_topic_names_and_types, guard condition."""
import sys
import rclpy
from rclpy.node import Node
from rclpy.utilities import remove_ros_args
from std_msgs.msg import Float64
from std_srvs.srv import SetBool


def main(argv=sys.argv):
    rclpy.init(args=["prog", "extra", "--ros-args", "-r", "chatter:=/talk/loud", "-r", "__node:=renamed", "-p", "gain:=2.5", "-p", "names:=[a, b]", "--log-level", "warn"])
    rest = remove_ros_args(args=["prog", "extra", "--ros-args", "-r", "x:=y"])
    n = Node("plain", allow_undeclared_parameters=True, automatically_declare_parameters_from_overrides=True)
    n.create_publisher(Float64, "chatter", 1)
    print(rest, n.get_name(), n.get_parameter("gain").value, list(n.get_parameter("names").value))
    print([t for t in n.get_topic_names_and_types() if t[0].startswith("/talk")], n.resolve_topic_name("chatter"), n.resolve_service_name("~/on"))
    n.get_logger().info("not shown")
    fired = []
    g = n.create_guard_condition(lambda: fired.append(1))
    g.trigger()
    rclpy.spin_once(n, timeout_sec=0.1)
    print("fired", len(fired))
    n.create_service(SetBool, "~/on", lambda q, r: r)
    print([s for s in n.get_service_names_and_types_by_node("renamed", "/") if s[0].endswith("/on")])
    n.set_parameters([rclpy.Parameter("new", value=[1, 2])])
    print(n.get_parameters_by_prefix("").keys() >= {"gain", "new"})
    m = rclpy.wait_for_message if hasattr(rclpy, "wait_for_message") else None
    from rclpy.wait_for_message import wait_for_message
    print(wait_for_message(Float64, n, "/silent", time_to_wait=0.5))
    n.destroy_node()
    rclpy.shutdown()


main()
