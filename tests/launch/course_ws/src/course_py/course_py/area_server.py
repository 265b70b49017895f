import rclpy
from course_interfaces.srv import ComputeArea
from rclpy.node import Node


class AreaServer(Node):
    def __init__(self):
        super().__init__("area_server")
        self.create_service(ComputeArea, "compute_area", self.compute)

    def compute(self, request, response):
        response.area = request.length * request.width
        return response


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(AreaServer())


if __name__ == "__main__":
    main()
