"""A camera driver that is brought up in stages, and a supervisor that leads it through its states."""

import rclpy
from lifecycle_msgs.msg import State, Transition, TransitionEvent
from lifecycle_msgs.srv import ChangeState, GetAvailableTransitions, GetState
from rclpy.executors import SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rclpy.node import Node
from std_msgs.msg import Int32


class Camera(LifecycleNode):
    def __init__(self):
        super().__init__("camera")
        self.attempts = 0
        self.frames = 0
        self.pub = None
        self.timer = None

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        self.attempts += 1
        if self.attempts == 1:
            self.get_logger().warning("no camera found")
            return TransitionCallbackReturn.FAILURE
        self.pub = self.create_lifecycle_publisher(Int32, "frames", 10)
        self.timer = self.create_timer(0.1, self.grab)
        self.get_logger().info(f"configured from {state.label}")
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state):
        if self.frames > 1000:
            return TransitionCallbackReturn.ERROR
        self.get_logger().info("active")
        return super().on_activate(state)

    def on_deactivate(self, state):
        self.get_logger().info(f"deactivated after {self.frames} frames")
        self.frames = 5000
        return super().on_deactivate(state)

    def on_cleanup(self, state):
        self.destroy_timer(self.timer)
        self.destroy_lifecycle_publisher(self.pub)
        self.timer = self.pub = None
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state):
        self.get_logger().info(f"shut down from {state.label}")
        return TransitionCallbackReturn.SUCCESS

    def on_error(self, state):
        self.get_logger().error("an error, starting anew")
        self.destroy_timer(self.timer)
        self.destroy_lifecycle_publisher(self.pub)
        self.frames = 0
        return TransitionCallbackReturn.SUCCESS

    def grab(self):
        self.pub.publish(Int32(data=self.frames))
        if self.pub.is_activated:
            self.frames += 1


class Supervisor(Node):
    STEPS = [
        (0.5, Transition.TRANSITION_CONFIGURE),
        (0.5, Transition.TRANSITION_CONFIGURE),
        (0.5, Transition.TRANSITION_ACTIVATE),
        (2.0, Transition.TRANSITION_DEACTIVATE),
        (0.5, Transition.TRANSITION_ACTIVATE),
        (0.5, Transition.TRANSITION_UNCONFIGURED_SHUTDOWN),
    ]

    def __init__(self):
        super().__init__("supervisor")
        self.change = self.create_client(ChangeState, "camera/change_state")
        self.ask = self.create_client(GetState, "camera/get_state")
        self.options = self.create_client(GetAvailableTransitions, "camera/get_available_transitions")
        self.create_subscription(TransitionEvent, "camera/transition_event", self.on_event, 10)
        self.step = 0
        self.done = rclpy.task.Future()
        self.wait = self.create_timer(self.STEPS[0][0], self.go)
        self.events = 0

    def on_event(self, event):
        self.events += 1

    def go(self):
        self.wait.cancel()
        request = ChangeState.Request()
        request.transition.id = self.STEPS[self.step][1]
        self.change.call_async(request).add_done_callback(self.changed)

    def changed(self, future):
        self.success = future.result().success
        self.ask.call_async(GetState.Request()).add_done_callback(self.told)

    def told(self, future):
        state = future.result().current_state
        self.get_logger().info(f"step {self.step}: success={self.success} now {state.label} ({state.id})")
        if state.id == State.PRIMARY_STATE_INACTIVE:
            self.options.call_async(GetAvailableTransitions.Request()).add_done_callback(self.listed)
        self.step += 1
        if self.step == len(self.STEPS):
            self.done.set_result(state.label)
            return
        self.wait = self.create_timer(self.STEPS[self.step][0], self.go)

    def listed(self, future):
        labels = sorted(each.transition.label for each in future.result().available_transitions)
        self.get_logger().info("possible: " + ", ".join(labels))


def main():
    rclpy.init()
    executor = SingleThreadedExecutor()
    camera, supervisor = Camera(), Supervisor()
    executor.add_node(camera)
    executor.add_node(supervisor)
    executor.spin_until_future_complete(supervisor.done)
    print("ended", supervisor.done.result(), supervisor.events > 8)
    rclpy.shutdown()


if __name__ == "__main__":
    main()
