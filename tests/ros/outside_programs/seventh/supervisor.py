import rclpy
from lifecycle_msgs.msg import Transition, TransitionEvent
from lifecycle_msgs.srv import ChangeState, GetAvailableTransitions, GetState
from rclpy.node import Node
from std_msgs.msg import UInt32


class Supervisor(Node):
    def __init__(self):
        super().__init__('supervisor')
        self.heard = []
        self.create_subscription(UInt32, 'beats', lambda m: self.heard.append(m.data), 10)
        self.create_subscription(TransitionEvent, 'heartbeat/transition_event', self.on_event, 10)
        self.path = []

    def on_event(self, e):
        self.path.append(e.goal_state.label)

    def ask(self, kind, name, request=None):
        client = self.create_client(kind, f'/heartbeat/{name}')
        assert client.wait_for_service(10.0), name
        future = client.call_async(request or kind.Request())
        rclpy.spin_until_future_complete(self, future)
        self.destroy_client(client)
        return future.result()

    def change(self, id_):
        request = ChangeState.Request(transition=Transition(id=id_))
        return self.ask(ChangeState, 'change_state', request).success

    def pause(self, seconds):
        until = self.get_clock().now() + rclpy.duration.Duration(seconds=seconds)
        while self.get_clock().now() < until:
            rclpy.spin_once(self, timeout_sec=0.05)


def main():
    rclpy.init()
    s = Supervisor()
    log = s.get_logger().info
    log(f'configure: {s.change(Transition.TRANSITION_CONFIGURE)}')
    log(f'again: {s.change(Transition.TRANSITION_CONFIGURE)}')
    s.pause(1.2)
    log(f'while inactive: {s.heard}')
    log('next: ' + ' '.join(sorted(t.transition.label for t in s.ask(GetAvailableTransitions, 'get_available_transitions').available_transitions)))
    log(f'activate: {s.change(Transition.TRANSITION_ACTIVATE)}')
    s.pause(2.2)
    log(f'state: {s.ask(GetState, "get_state").current_state.label}')
    log(f'deactivate: {s.change(Transition.TRANSITION_DEACTIVATE)}')
    log(f'while active: {len(s.heard) >= 4} {s.heard == sorted(s.heard)}')
    log(f'cleanup: {s.change(Transition.TRANSITION_CLEANUP)}')
    log(f'shutdown: {s.change(Transition.TRANSITION_UNCONFIGURED_SHUTDOWN)}')
    s.pause(0.2)
    log('path: ' + ' '.join(s.path))
    rclpy.shutdown()


if __name__ == '__main__':
    main()
