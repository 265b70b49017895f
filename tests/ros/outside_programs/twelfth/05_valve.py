"""A managed valve with a bad day: each failure of a transition, and where it leads, told by its own topic and services."""
import rclpy
from lifecycle_msgs.msg import State, Transition, TransitionEvent
from lifecycle_msgs.srv import ChangeState, GetAvailableTransitions, GetState
from rclpy.executors import SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_msgs.msg import Float32


class Valve(LifecycleNode):
    def __init__(self):
        super().__init__('valve')
        self.script = {'configure': ['fail', 'ok', 'ok'], 'activate': ['raise', 'fail', 'ok']}
        self.flow = None

    def act(self, name):
        word = self.script[name].pop(0)
        if word == 'raise':
            raise RuntimeError('stuck')
        return TransitionCallbackReturn.SUCCESS if word == 'ok' else TransitionCallbackReturn.FAILURE

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        result = self.act('configure')
        if result == TransitionCallbackReturn.SUCCESS:
            self.flow = self.create_lifecycle_publisher(Float32, 'flow', QoSProfile(depth=10))
            self.timer = self.create_timer(0.1, lambda: self.flow.publish(Float32(data=0.5)))
        return result

    def on_activate(self, state):
        print('activating from', state.label)
        result = self.act('activate')
        return super().on_activate(state) if result == TransitionCallbackReturn.SUCCESS else result

    def on_deactivate(self, state):
        return super().on_deactivate(state)

    def on_cleanup(self, state):
        self.destroy_timer(self.timer)
        self.destroy_lifecycle_publisher(self.flow)
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state):
        print('shutting down from', state.label)
        return TransitionCallbackReturn.SUCCESS

    def on_error(self, state):
        print('error in', state.label)
        self.on_cleanup(state)
        return TransitionCallbackReturn.SUCCESS


class Operator(Node):
    def __init__(self):
        super().__init__('operator')
        self.change = self.create_client(ChangeState, '/valve/change_state')
        self.state = self.create_client(GetState, '/valve/get_state')
        self.ways = self.create_client(GetAvailableTransitions, '/valve/get_available_transitions')
        self.create_subscription(TransitionEvent, '/valve/transition_event', self.on_event, 10)
        self.create_subscription(Float32, 'flow', self.on_flow, 10)
        self.flows = 0
        self.events = []

    def on_event(self, event):
        self.events.append(f'{event.start_state.label}>{event.goal_state.label}')

    def on_flow(self, message):
        self.flows += 1


def main():
    rclpy.init()
    valve, operator = Valve(), Operator()
    executor = SingleThreadedExecutor()
    executor.add_node(valve)
    executor.add_node(operator)

    def call(client, request):
        client.wait_for_service()
        future = client.call_async(request)
        executor.spin_until_future_complete(future)
        return future.result()

    def change(which):
        request = ChangeState.Request(transition=Transition(id=which))
        done = call(operator.change, request).success
        state = call(operator.state, GetState.Request()).current_state
        print('changed', which, done, state.label, state.id)
        return state.id

    def wait(seconds):
        end = operator.get_clock().now() + rclpy.duration.Duration(seconds=seconds)
        while operator.get_clock().now() < end:
            executor.spin_once(timeout_sec=0.05)

    change(Transition.TRANSITION_CONFIGURE)
    change(Transition.TRANSITION_CONFIGURE)
    ways = call(operator.ways, GetAvailableTransitions.Request()).available_transitions
    print('ways', sorted(way.transition.label for way in ways))
    wait(0.55)
    print('inactive flows', operator.flows)
    change(Transition.TRANSITION_ACTIVATE)
    change(Transition.TRANSITION_CONFIGURE)
    change(Transition.TRANSITION_ACTIVATE)
    assert change(Transition.TRANSITION_ACTIVATE) == State.PRIMARY_STATE_ACTIVE
    wait(1.02)
    print('active flows', operator.flows)
    change(Transition.TRANSITION_DEACTIVATE)
    change(Transition.TRANSITION_CONFIGURE)
    change(Transition.TRANSITION_INACTIVE_SHUTDOWN)
    wait(0.2)
    print('events', len(operator.events), operator.events[0], operator.events[-1])
    rclpy.shutdown()


if __name__ == '__main__':
    main()
