import sys
import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import SingleThreadedExecutor, TimeoutException, ShutdownException
from rclpy.node import Node
from rclpy.task import Future


class Adder(Node):
    def __init__(self):
        super().__init__('adder')
        self.srv = self.create_service(AddTwoInts, 'add', self.add, callback_group=ReentrantCallbackGroup())
        self.pending = []

    async def add(self, request, response):
        """Answers only when `release` is triggered."""
        gate = Future()
        self.pending.append(gate)
        await gate
        response.sum = request.a + request.b
        return response


class User(Node):
    def __init__(self, adder):
        super().__init__('user', start_parameter_services=False)
        self.adder = adder
        self.cli = self.create_client(AddTwoInts, 'add')
        self.guard = self.create_guard_condition(self.release)
        self.sums = []
        self.timer = self.create_timer(0.3, self.tick)
        self.ticks = 0

    async def work(self, a, b):
        response = await self.cli.call_async(AddTwoInts.Request(a=a, b=b))
        self.sums.append(response.sum)
        return response.sum

    def release(self):
        for gate in self.adder.pending:
            gate.set_result(None)
        n = len(self.adder.pending)
        self.adder.pending.clear()
        self.get_logger().info(f'released {n}')

    def tick(self):
        self.ticks += 1
        if self.ticks == 4:
            self.guard.trigger()


def failing():
    raise ValueError('boom')


def main():
    rclpy.init()
    adder = Adder()
    user = User(adder)
    executor = SingleThreadedExecutor()
    for n in (adder, user):
        assert executor.add_node(n)
    assert not executor.add_node(user)
    assert user.cli.wait_for_service(1.0)
    tasks = [executor.create_task(user.work, i, 10 * i) for i in (1, 2, 3)]
    plain = executor.create_task(lambda: 42)
    for t in tasks + [plain]:
        executor.spin_until_future_complete(t, timeout_sec=5.0)
    print([t.result() for t in tasks], plain.result(), tasks[0].done(), tasks[0].cancelled())
    bad = executor.create_task(failing)
    try:
        executor.spin_until_future_complete(bad, timeout_sec=1.0)
    except ValueError as e:
        print('raised', e)
    print('exception', type(bad.exception()).__name__)
    never = Future()
    t0 = user.get_clock().now()
    executor.spin_until_future_complete(never, timeout_sec=0.5)
    waited = (user.get_clock().now() - t0).nanoseconds / 1e9
    print('timeout', never.done(), 0.45 <= waited <= 0.65)
    never.cancel()
    print('cancelled', never.cancelled(), never.done())
    print('nodes', sorted(n.get_name() for n in executor.get_nodes()))
    executor.remove_node(adder)
    adder.destroy_node()
    print('service gone', not user.cli.service_is_ready())
    print('shutdown', executor.shutdown(timeout_sec=1.0))
    try:
        executor.spin_once(timeout_sec=0)
    except (ShutdownException, RuntimeError, Exception) as e:
        print('after shutdown', type(e).__name__)
    rclpy.shutdown()
    print('ok', rclpy.ok())
    try:
        rclpy.shutdown()
    except Exception as e:
        print('twice', type(e).__name__)
    sys.exit(3)


if __name__ == '__main__':
    main()
