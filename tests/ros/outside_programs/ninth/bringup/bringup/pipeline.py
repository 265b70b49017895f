import rclpy
from rclpy.node import Node
from std_msgs.msg import Int64


class Source(Node):
    def __init__(self):
        super().__init__("source")
        self.step = self.declare_parameter("step", 1).value
        self.count = 0
        self.pub = self.create_publisher(Int64, "out", 10)
        self.create_timer(self.declare_parameter("period", 1.0).value, self.tick)

    def tick(self):
        self.count += self.step
        self.pub.publish(Int64(data=self.count))


class Scale(Node):
    def __init__(self):
        super().__init__("scale")
        self.factor = self.declare_parameter("factor", 1).value
        self.pub = self.create_publisher(Int64, "out", 10)
        self.create_subscription(Int64, "in", self.on_value, 10)
        self.get_logger().info(f"{self.get_fully_qualified_name()} multiplies by {self.factor}")

    def on_value(self, msg):
        self.pub.publish(Int64(data=msg.data * self.factor))


class Sink(Node):
    def __init__(self):
        super().__init__("sink")
        self.declare_parameters("", [("title", "nothing"), ("limits.low", 0), ("limits.high", 0), ("tags", [""])])
        self.create_subscription(Int64, "in", self.on_value, 10)
        low, high = (self.get_parameter(f"limits.{each}").value for each in ("low", "high"))
        self.get_logger().info(f"{self.get_parameter('title').value} {low}..{high} {self.get_parameter('tags').value}")
        self.low, self.high = low, high

    def on_value(self, msg):
        if self.low <= msg.data <= self.high:
            self.get_logger().info(f"{self.get_parameter('title').value}: {msg.data}")


def run(kind):
    rclpy.init()
    node = kind()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    node.destroy_node()
    rclpy.try_shutdown()


def source():
    run(Source)


def scale():
    run(Scale)


def sink():
    run(Sink)
