"""A managed talker, driven by its own state services from a second node; a failed configure at first."""
import rclpy
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState, GetState
from rclpy.executors import SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode, State, TransitionCallbackReturn
from rclpy.node import Node
from std_msgs.msg import String


class Talker(LifecycleNode):
    def __init__(self):
        super().__init__("lc_talker")
        self.tries = 0
        self.timer = None

    def on_configure(self, state: State):
        self.tries += 1
        if self.tries == 1:
            return TransitionCallbackReturn.FAILURE
        self.pub = self.create_lifecycle_publisher(String, "lc_chatter", 10)
        self.timer = self.create_timer(0.1, lambda: self.pub.publish(String(data="hi")))
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state):
        print("activating from", state.label)
        return super().on_activate(state)

    def on_cleanup(self, state):
        self.destroy_timer(self.timer)
        self.destroy_publisher(self.pub)
        return TransitionCallbackReturn.SUCCESS


class Manager(Node):
    def __init__(self):
        super().__init__("manager")
        self.change = self.create_client(ChangeState, "/lc_talker/change_state")
        self.state = self.create_client(GetState, "/lc_talker/get_state")
        self.heard = 0
        self.create_subscription(String, "lc_chatter", self.hear, 10)

    def hear(self, m):
        self.heard += 1

    async def go(self, transition):
        r = await self.change.call_async(ChangeState.Request(transition=Transition(id=transition)))
        s = await self.state.call_async(GetState.Request())
        print(r.success, s.current_state.label, s.current_state.id)


def wait(ex, node, seconds):
    end = node.get_clock().now() + rclpy.duration.Duration(seconds=seconds)
    while node.get_clock().now() < end:
        ex.spin_once(timeout_sec=0.05)


def main():
    rclpy.init()
    ex = SingleThreadedExecutor()
    t, m = Talker(), Manager()
    ex.add_node(t)
    ex.add_node(m)
    for step in (Transition.TRANSITION_CONFIGURE, Transition.TRANSITION_CONFIGURE, "wait", Transition.TRANSITION_ACTIVATE, "wait",
                 Transition.TRANSITION_DEACTIVATE, Transition.TRANSITION_CLEANUP, Transition.TRANSITION_UNCONFIGURED_SHUTDOWN):
        if step == "wait":
            wait(ex, m, 1.0)
            print("heard", "some" if m.heard else "nothing")
            continue
        ex.spin_until_future_complete(ex.create_task(m.go(step)))
    rclpy.shutdown()


main()
