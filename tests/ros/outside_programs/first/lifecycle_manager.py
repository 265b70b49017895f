#!/usr/bin/env python3
# configure, 2 s later activate, 4 s later deactivate, clean up
import time
import rclpy
from rclpy.node import Node
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState, GetState


class Manager(Node):
    def __init__(self):
        super().__init__('lifecycle_manager')
        self.change = self.create_client(ChangeState, '/lc_talker/change_state')
        self.state = self.create_client(GetState, '/lc_talker/get_state')
        self.change.wait_for_service()
        self.state.wait_for_service()

    def do(self, transition_id):
        req = ChangeState.Request()
        req.transition.id = transition_id
        f = self.change.call_async(req)
        rclpy.spin_until_future_complete(self, f)
        g = self.state.call_async(GetState.Request())
        rclpy.spin_until_future_complete(self, g)
        print(f.result().success, '->', g.result().current_state.label, flush=True)


rclpy.init()
m = Manager()
m.do(Transition.TRANSITION_CONFIGURE)
time.sleep(2)
m.do(Transition.TRANSITION_ACTIVATE)
time.sleep(4)
m.do(Transition.TRANSITION_DEACTIVATE)
m.do(Transition.TRANSITION_CLEANUP)
m.destroy_node()
rclpy.shutdown()
