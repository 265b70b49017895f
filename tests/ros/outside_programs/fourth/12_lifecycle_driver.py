import rclpy
from geometry_msgs.msg import Twist
from lifecycle_msgs.msg import State as StateMsg, Transition
from lifecycle_msgs.srv import ChangeState, GetState
from rclpy.executors import SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode, LifecyclePublisher, State, TransitionCallbackReturn
from rclpy.node import Node


class Driver(LifecycleNode):
    def __init__(self):
        super().__init__("driver")
        self.pub: LifecyclePublisher | None = None
        self.timer = None
        self.sent = 0
        self.attempts = 0

    def on_configure(self, state: State) -> TransitionCallbackReturn:
        self.attempts += 1
        if self.attempts == 1:
            self.get_logger().error("motor not found")
            return TransitionCallbackReturn.FAILURE
        self.pub = self.create_lifecycle_publisher(Twist, "cmd_vel", 10)
        self.timer = self.create_timer(0.1, self.drive)
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: State) -> TransitionCallbackReturn:
        self.get_logger().info("from " + state.label)
        return super().on_activate(state)

    def on_deactivate(self, state: State) -> TransitionCallbackReturn:
        self.pub.publish(Twist())
        return super().on_deactivate(state)

    def on_cleanup(self, state):
        self.destroy_timer(self.timer)
        self.destroy_lifecycle_publisher(self.pub)
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state):
        self.get_logger().info("shutting down from " + state.label)
        return TransitionCallbackReturn.SUCCESS

    def drive(self):
        if not self.pub.is_activated:
            return
        msg = Twist()
        msg.linear.x = 0.3
        self.pub.publish(msg)
        self.sent += 1


class Manager(Node):
    def __init__(self, executor):
        super().__init__("manager")
        self.change = self.create_client(ChangeState, "driver/change_state")
        self.ask = self.create_client(GetState, "driver/get_state")
        self.exec = executor

    def to(self, transition):
        request = ChangeState.Request()
        request.transition.id = transition
        future = self.change.call_async(request)
        self.exec.spin_until_future_complete(future)
        state = self.ask.call_async(GetState.Request())
        self.exec.spin_until_future_complete(state)
        print(future.result().success, state.result().current_state.label, flush=True)
        return state.result().current_state.id

    def let(self, seconds):
        end = self.get_clock().now() + rclpy.duration.Duration(seconds=seconds)
        while self.get_clock().now() < end:
            self.exec.spin_once(timeout_sec=0.1)


def main():
    rclpy.init()
    executor = SingleThreadedExecutor()
    driver, manager = Driver(), Manager(executor)
    executor.add_node(driver)
    executor.add_node(manager)
    assert manager.change.wait_for_service(timeout_sec=5.0)
    manager.to(Transition.TRANSITION_CONFIGURE)
    assert manager.to(Transition.TRANSITION_CONFIGURE) == StateMsg.PRIMARY_STATE_INACTIVE
    manager.let(1.0)
    manager.to(Transition.TRANSITION_ACTIVATE)
    manager.let(3.0)
    manager.to(Transition.TRANSITION_DEACTIVATE)
    manager.let(1.0)
    manager.to(Transition.TRANSITION_CLEANUP)
    manager.to(Transition.TRANSITION_UNCONFIGURED_SHUTDOWN)
    print("sent", driver.sent)
    rclpy.shutdown()


main()
