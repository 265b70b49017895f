"""An order service that awaits two other services in its callback, with one thread."""

import rclpy
from example_interfaces.srv import AddTwoInts, SetBool
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future


class Kitchen(Node):
    def __init__(self):
        super().__init__("kitchen")
        self.group = ReentrantCallbackGroup()
        self.create_service(AddTwoInts, "price", self.price, callback_group=self.group)
        self.create_service(SetBool, "oven", self.oven, callback_group=self.group)
        self.create_service(AddTwoInts, "order", self.order, callback_group=self.group)
        self.ask_price = self.create_client(AddTwoInts, "price", callback_group=self.group)
        self.ask_oven = self.create_client(SetBool, "oven", callback_group=self.group)
        self.is_hot = Future()

    async def price(self, request, response):
        await self.pause(0.3)
        response.sum = request.a * 10 + request.b
        return response

    def oven(self, request, response):
        response.success = request.data
        response.message = "hot" if request.data else "cold"
        if not self.is_hot.done():
            self.is_hot.set_result(response.message)
        return response

    async def pause(self, seconds):
        done = Future()
        timer = self.create_timer(seconds, lambda: done.set_result(None) if not done.done() else None, callback_group=self.group)
        await done
        self.destroy_timer(timer)

    async def order(self, request, response):
        oven = await self.ask_oven.call_async(SetBool.Request(data=True))
        price = await self.ask_price.call_async(AddTwoInts.Request(a=request.a, b=request.b))
        self.get_logger().info(f"order of {request.a}: oven {oven.message}, price {price.sum}")
        response.sum = price.sum
        return response


async def dine(node, client):
    total = 0
    for guests in (1, 2, 3):
        answer = await client.call_async(AddTwoInts.Request(a=guests, b=5))
        total += answer.sum
    return total


async def announce(node):
    told = await node.is_hot
    node.get_logger().info(f"the oven is {told}")


async def burn():
    raise ValueError("burnt")


def main():
    rclpy.init()
    kitchen, guest = Kitchen(), Node("guest")
    client = guest.create_client(AddTwoInts, "order")
    executor = SingleThreadedExecutor()
    executor.add_node(kitchen)
    executor.add_node(guest)
    news = executor.create_task(announce, kitchen)
    bill = executor.create_task(dine, guest, client)
    start = guest.get_clock().now()
    executor.spin_until_future_complete(bill)
    took = (guest.get_clock().now() - start).nanoseconds / 1e9
    print(f"bill {bill.result()} after {took:.1f} s, news told {news.done()}")
    failed = executor.create_task(burn)
    try:
        executor.spin_until_future_complete(failed, timeout_sec=1.0)
    except ValueError:
        pass
    print(f"failed with {failed.exception()!r}")
    never = Future()
    executor.spin_until_future_complete(never, timeout_sec=0.5)
    print(f"still waiting {not never.done()}")
    never.cancel()
    print(f"cancelled {never.cancelled()}")
    rclpy.shutdown()


if __name__ == "__main__":
    main()
