"""A shop: messages of our own, nested, bounded, with constants and defaults; a service of our own; and everything seen from outside."""
import copy

import rclpy
from builtin_interfaces.msg import Time
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rosidl_runtime_py import message_to_csv, message_to_ordereddict, message_to_yaml, set_message_fields
from rosidl_runtime_py.utilities import get_message, get_service
from shop_interfaces.msg import Basket, Item
from shop_interfaces.srv import Checkout


class Till(Node):
    def __init__(self):
        super().__init__('till')
        self.create_service(Checkout, '~/checkout', self.checkout)

    def checkout(self, request: Checkout.Request, response: Checkout.Response):
        response.total = sum(item.price for item in request.basket.items)
        if 'HALF' in request.coupons:
            response.total /= 2
        fragile = [item.name for item in request.basket.items if item.fragile]
        if fragile:
            response.state = Checkout.Response.REFUSED
            response.message = f'too fragile: {", ".join(fragile)}'
        return response


def main(args=None):
    rclpy.init(args=args)
    item = Item()
    print('defaults', item.name, item.price, item.kind == Item.FOOD, item.fragile, Item.DEFAULT_NAME)
    print(Item(name='hammer', price=9.0, kind=Item.TOOL))
    basket = Basket(stamp=Time(sec=3, nanosec=5), owner='ana', items=[Item(), Item(name='pan', price=20.25)])
    print('corner', list(basket.corner), 'shelves', basket.shelves.tolist(), type(basket.shelves).__name__)
    print('types', Basket.get_fields_and_field_types()['items'], Basket.get_fields_and_field_types()['owner'])
    twin = copy.deepcopy(basket)
    twin.items[1].price = 1.0
    print('equal', basket == copy.copy(basket), basket == twin, Item() == Item())
    print('csv', message_to_csv(basket.items[1]))
    print('dict', list(message_to_ordereddict(basket).items())[1])
    print(message_to_yaml(basket.items[1]))
    filled = get_message('shop_interfaces/msg/Basket')()
    set_message_fields(filled, {'owner': 'bo', 'items': [{'name': 'nail', 'price': 0.25}], 'corner': [1.0, 2.0, 3.0]})
    print('filled', filled.owner, filled.items[0].name, filled.items[0].kind, filled.corner[2])

    till, customer = Till(), Node('customer')
    executor = MultiThreadedExecutor(num_threads=2)
    executor.add_node(till)
    executor.add_node(customer)
    client = customer.create_client(get_service('shop_interfaces/srv/Checkout'), '/till/checkout')
    assert client.wait_for_service(timeout_sec=2.0)
    for coupons, fragile in (([], False), (['HALF'], False), ([], True)):
        basket.items[1].fragile = fragile
        future = client.call_async(Checkout.Request(basket=basket, coupons=coupons))
        executor.spin_until_future_complete(future, timeout_sec=2.0)
        answer = future.result()
        print(f'total {answer.total:.3f}', 'paid' if answer.state == Checkout.Response.PAID else answer.message)
    names = dict(customer.get_service_names_and_types_by_node('till', '/'))
    print('seen', names['/till/checkout'])
    executor.shutdown()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
