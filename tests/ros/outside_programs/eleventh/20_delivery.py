import enum

import rclpy
from course_interfaces.msg import Parcel, RobotStatus
from course_interfaces.srv import AssignParcel
from geometry_msgs.msg import Point
from rclpy.node import Node
from rosidl_runtime_py import message_to_ordereddict, set_message_fields


class State(enum.IntEnum):
    IDLE = RobotStatus.IDLE
    LOADING = RobotStatus.LOADING
    DRIVING = RobotStatus.DRIVING
    CHARGING = RobotStatus.CHARGING


NEXT = {State.LOADING: (State.DRIVING, 1.0), State.DRIVING: (State.CHARGING, 2.0), State.CHARGING: (State.IDLE, 1.0)}


class Delivery(Node):
    def __init__(self):
        super().__init__('delivery')
        self.status = RobotStatus(state=RobotStatus.IDLE, doors=[True, False])
        self.status.route = [Point(x=float(x)) for x in range(3)]
        self.states = [State.IDLE]
        self.since = self.get_clock().now()
        self.over = rclpy.task.Future()
        self.pub = self.create_publisher(RobotStatus, 'status', 10)
        self.create_service(AssignParcel, 'assign', self.assign)
        self.create_timer(0.1, self.step)

    def assign(self, request, response):
        if len(self.status.load) >= AssignParcel.Request.MAX:
            response.accepted, response.reason = False, 'full'
            return response
        self.status.load.append(request.parcel)
        response.accepted = True
        if len(self.status.load) == AssignParcel.Request.MAX:
            self.enter(State.LOADING)
        return response

    def enter(self, state):
        self.status.state = int(state)
        self.states.append(state)
        self.since = self.get_clock().now()

    def step(self):
        state = State(self.status.state)
        self.status.header.stamp = self.get_clock().now().to_msg()
        self.pub.publish(self.status)
        if state in NEXT:
            following, seconds = NEXT[state]
            if (self.get_clock().now() - self.since).nanoseconds >= seconds * 1e9:
                self.enter(following)
                if following == State.IDLE:
                    self.over.set_result(None)


def main():
    rclpy.init()
    node = Delivery()
    parcel = Parcel()
    print('default', type(parcel).__name__, parcel.label, parcel.weight, parcel.size.tolist(), Parcel.DEPOT)
    try:
        parcel.label = 'a label of far more than sixteen characters'
    except (AssertionError, ValueError) as error:
        print('bounds:', type(error).__name__)
    client = node.create_client(AssignParcel, 'assign')
    client.wait_for_service()
    words = []
    for name, flags in (('a', Parcel.FRAGILE), ('b', Parcel.HEAVY), ('c', 0)):
        parcel = Parcel()
        set_message_fields(parcel, {'label': name, 'flags': flags, 'size': [1, 2, 3]})
        future = client.call_async(AssignParcel.Request(parcel=parcel))
        rclpy.spin_until_future_complete(node, future)
        answer = future.result()
        words.append(f'{name} accepted' if answer.accepted else f'{name} refused: {answer.reason}')
    print(', '.join(words))
    rclpy.spin_until_future_complete(node, node.over)
    print('states', *(state.name for state in node.states))
    assert message_to_ordereddict(node.status)['load'][1]['flags'] == Parcel.HEAVY
    print('slots:', Parcel.get_fields_and_field_types())
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
