import time

import rclpy
from rclpy.node import Node
from std_srvs.srv import SetBool, Trigger


class Enabler(Node):
    def __init__(self):
        super().__init__('enabler')
        self.enable = self.create_client(SetBool, '/tree/enable')
        self.turns = self.create_client(Trigger, '/tree/turns')

    def ask(self, client, request):
        while not client.wait_for_service(0.5):
            pass
        future = client.call_async(request)
        while rclpy.ok():
            rclpy.spin_once(self)
            if future.done():
                return future.result()


rclpy.init()
node = Enabler()
time.sleep(2)
print(node.ask(node.enable, SetBool.Request(data=True)).message, flush=True)
time.sleep(30)
print(node.ask(node.enable, SetBool.Request(data=False)).message, flush=True)
print('turns', node.ask(node.turns, Trigger.Request()).message, flush=True)
