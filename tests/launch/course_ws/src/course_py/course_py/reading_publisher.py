import rclpy
from course_interfaces.msg import Reading
from rclpy.node import Node


class ReadingPublisher(Node):
    def __init__(self):
        super().__init__("reading_publisher")
        self.declare_parameter("period", 1.0)
        self.declare_parameter("scale", 1.0)
        self.publisher = self.create_publisher(Reading, "reading", 10)
        self.count = 0
        self.create_timer(self.get_parameter("period").value, self.publish)

    def publish(self):
        reading = Reading()
        reading.header.stamp = self.get_clock().now().to_msg()
        reading.kind = Reading.KIND_BATTERY
        reading.value = self.count * self.get_parameter("scale").value
        reading.samples = [0.5, float(self.count)]
        self.publisher.publish(reading)
        self.count += 1


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(ReadingPublisher())


if __name__ == "__main__":
    main()
