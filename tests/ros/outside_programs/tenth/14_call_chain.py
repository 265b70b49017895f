"""Services that call services inside their callbacks, in both ways that the documentation allows.

Meant: shop -> stock -> supplier; the shop calls synchronously (reentrant group, several threads),
the stock awaits; orders come from a timer that calls synchronously too. Three orders, right sums.
A client without a server times out, and a call with a timeout raises.
"""
import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


class Supplier(Node):
    def __init__(self):
        super().__init__('supplier')
        self.create_service(AddTwoInts, 'supply', self.supply)

    def supply(self, request, response):
        self.get_clock().sleep_for(rclpy.duration.Duration(seconds=0.2))
        response.sum = request.a * 10 + request.b
        return response


class Stock(Node):
    def __init__(self):
        super().__init__('stock')
        group = ReentrantCallbackGroup()
        self.client = self.create_client(AddTwoInts, 'supply', callback_group=group)
        self.create_service(AddTwoInts, 'stock', self.take, callback_group=group)

    async def take(self, request, response):
        answer = await self.client.call_async(AddTwoInts.Request(a=request.a, b=request.b))
        response.sum = answer.sum + 1
        return response


class Shop(Node):
    def __init__(self):
        super().__init__('shop')
        self.stock = self.create_client(
            AddTwoInts, 'stock', callback_group=MutuallyExclusiveCallbackGroup())
        self.create_service(AddTwoInts, 'shop', self.sell,
                            callback_group=MutuallyExclusiveCallbackGroup())

    def sell(self, request, response):
        answer = self.stock.call(request)
        self.get_logger().info(f'sold {request.a}, {request.b} -> {answer.sum}')
        response.sum = answer.sum * 2
        return response


class Buyer(Node):
    def __init__(self):
        super().__init__('buyer')
        self.shop = self.create_client(
            AddTwoInts, 'shop', callback_group=MutuallyExclusiveCallbackGroup())
        self.nobody = self.create_client(AddTwoInts, 'nobody')
        self.orders = [(1, 2), (3, 4), (5, 6)]
        self.sums = []
        self.timer = self.create_timer(0.5, self.buy, MutuallyExclusiveCallbackGroup())
        self.done = False

    def buy(self):
        if not self.orders:
            self.timer.cancel()
            self.get_logger().info(f'nobody there: {self.nobody.wait_for_service(timeout_sec=0.3)}')
            try:
                self.nobody.call(AddTwoInts.Request(), timeout_sec=0.3)
            except TimeoutError:
                self.get_logger().info('timed out')
            self.done = True
            return
        a, b = self.orders.pop(0)
        before = self.get_clock().now()
        self.sums.append(self.shop.call(AddTwoInts.Request(a=a, b=b)).sum)
        took = (self.get_clock().now() - before).nanoseconds / 1e9
        self.get_logger().info(f'took its time: {0.15 < took < 0.5}')


def main():
    rclpy.init()
    executor = MultiThreadedExecutor()
    nodes = [Supplier(), Stock(), Shop(), Buyer()]
    for node in nodes:
        executor.add_node(node)
    while not nodes[-1].done:
        executor.spin_once(timeout_sec=1.0)
    print('sums', nodes[-1].sums)
    executor.shutdown()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
