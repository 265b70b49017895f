"""Services in every order: asynchronous callbacks that await, a service that is late, requests given up, blocking calls from a thread."""
import threading

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from std_srvs.srv import SetBool, Trigger


class Adder(Node):
    def __init__(self):
        super().__init__('adder')
        self.group = ReentrantCallbackGroup()
        self.service = self.create_service(AddTwoInts, 'add', self.add, callback_group=self.group)
        self.calls = 0

    def add(self, request, response):
        self.calls += 1
        self.get_clock().sleep_for(Duration(seconds=0.2))
        response.sum = request.a + request.b
        return response


class Product(Node):
    """Multiplies by adding: each request awaits the adder again and again."""

    def __init__(self):
        super().__init__('product')
        group = ReentrantCallbackGroup()
        self.client = self.create_client(AddTwoInts, 'add', callback_group=group)
        self.create_service(AddTwoInts, 'multiply', self.multiply, callback_group=group)

    async def multiply(self, request, response):
        total = 0
        for _ in range(request.b):
            answer = await self.client.call_async(AddTwoInts.Request(a=total, b=request.a))
            total = answer.sum
        response.sum = total
        return response


class Gate(Node):
    def __init__(self):
        super().__init__('gate')
        self.opened = False
        self.create_service(SetBool, 'gate/open', self.open)
        self.create_service(Trigger, 'gate/state', self.state)

    def open(self, request, response):
        response.success = request.data != self.opened
        response.message = 'changed' if response.success else 'it was so'
        self.opened = request.data
        return response

    def state(self, request, response):
        return Trigger.Response(success=self.opened, message='open' if self.opened else 'closed')


def main():
    rclpy.init()
    user = Node('user')
    nodes = [Adder(), Product(), Gate(), user]
    executor = MultiThreadedExecutor(num_threads=8)
    for node in nodes:
        executor.add_node(node)
    thread = threading.Thread(target=executor.spin, daemon=True)
    thread.start()

    multiply = user.create_client(AddTwoInts, 'multiply')
    print('there', multiply.wait_for_service(timeout_sec=2.0), multiply.service_is_ready(), multiply.srv_name)
    begun = user.get_clock().now()
    print('product', multiply.call(AddTwoInts.Request(a=7, b=4)).sum,
          f'in {(user.get_clock().now() - begun).nanoseconds / 1e9:.1f} s')

    add = user.create_client(AddTwoInts, 'add', callback_group=MutuallyExclusiveCallbackGroup())
    begun = user.get_clock().now()
    futures = [add.call_async(AddTwoInts.Request(a=number, b=number)) for number in range(5)]
    event = threading.Event()
    futures[-1].add_done_callback(lambda future: event.set())
    event.wait(timeout=5.0)
    while not all(future.done() for future in futures):
        user.get_clock().sleep_for(Duration(seconds=0.01))
    print('at once', [future.result().sum for future in futures],
          (user.get_clock().now() - begun).nanoseconds / 1e9 < 0.9)

    late = add.call_async(AddTwoInts.Request(a=1, b=1))
    add.remove_pending_request(late)
    user.get_clock().sleep_for(Duration(seconds=0.5))
    print('given up', late.done(), nodes[0].calls)

    gate = user.create_client(SetBool, '/gate/open')
    print('gate', *(gate.call(SetBool.Request(data=value)).message for value in (True, True, False)))
    state = user.create_client(Trigger, 'gate/state')
    print('state', state.call(Trigger.Request()).message)

    nobody = user.create_client(Trigger, 'nobody')
    print('nobody', nobody.wait_for_service(timeout_sec=0.5), nobody.service_is_ready())
    try:
        gate.call(Trigger.Request())
    except TypeError:
        print('wrong type refused')
    try:
        gate.call(SetBool.Request(data=True), timeout_sec=2.0)
        print('in time')
    except TypeError:
        print('no time limit in this distribution')
    nodes[2].destroy_node()
    user.get_clock().sleep_for(Duration(seconds=0.2))
    print('closed', gate.service_is_ready())
    print('services', sorted(name for name, kinds in user.get_service_names_and_types() if kinds == ['example_interfaces/srv/AddTwoInts']))
    executor.shutdown()
    rclpy.shutdown()
    thread.join(timeout=2)


if __name__ == '__main__':
    main()
