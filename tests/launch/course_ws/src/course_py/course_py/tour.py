"""Uses all the other nodes once, says what it has seen, and ends."""

import rclpy
from course_interfaces.action import CountUntil
from course_interfaces.msg import Reading
from course_interfaces.srv import ComputeArea
from rclpy.action import ActionClient
from rclpy.node import Node
from std_msgs.msg import String


class Tour(Node):
    def __init__(self):
        super().__init__("tour")
        self.declare_parameter("target", 1)
        self.declare_parameter("title", "")
        self.readings = []
        self.pictures = []
        self.feedback = []
        self.create_subscription(Reading, "battery", self.readings.append, 10)
        self.create_subscription(String, "pictures", self.pictures.append, 10)
        self.area = self.create_client(ComputeArea, "compute_area")
        self.counter = ActionClient(self, CountUntil, "count_until")

    def go(self):
        self.area.wait_for_service()
        request = ComputeArea.Request()
        request.length, request.width = 2.0, 3.5
        future = self.area.call_async(request)
        rclpy.spin_until_future_complete(self, future)
        self.get_logger().info(f"area {future.result().area}")
        self.counter.wait_for_server()
        goal = CountUntil.Goal()
        goal.target = self.get_parameter("target").value
        sent = self.counter.send_goal_async(
            goal, feedback_callback=lambda m: self.feedback.append(m.feedback.current)
        )
        rclpy.spin_until_future_complete(self, sent)
        result = sent.result().get_result_async()
        rclpy.spin_until_future_complete(self, result)
        self.get_logger().info(f"counted {self.feedback} to {result.result().result.reached}")
        while len(self.readings) < 3 or not self.pictures:
            rclpy.spin_once(self)
        last = self.readings[-1]
        self.get_logger().info(f"battery {last.value / last.samples[-1]} {last.unit} kind {last.kind}")
        self.get_logger().info(
            f"{self.get_parameter('title').value}: {self.pictures[0].data} in {self.get_namespace()}"
        )


def main(args=None):
    rclpy.init(args=args)
    tour = Tour()
    tour.go()
    tour.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
