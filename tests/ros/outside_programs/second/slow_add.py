import time
import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class SlowAdd(Node):
    def __init__(self):
        super().__init__('slow_add')
        self.srv = self.create_service(AddTwoInts, 'slow_add', self.add)

    def add(self, req, res):
        time.sleep(0.7)
        res.sum = req.a + req.b
        return res


rclpy.init()
rclpy.spin(SlowAdd())
