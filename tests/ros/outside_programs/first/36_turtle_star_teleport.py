#!/usr/bin/env python3
# star by teleporting with the pen down, in red, then back to the middle with the pen up
import math
import sys
import rclpy
from std_srvs.srv import Empty
from turtlesim.srv import TeleportAbsolute, SetPen

rclpy.init(args=sys.argv)
node = rclpy.create_node('star')
log = node.get_logger()


def call(srv_type, name, **fields):
    cli = node.create_client(srv_type, name)
    if not cli.wait_for_service(timeout_sec=5.0):
        log.fatal(name + ' not there')
        sys.exit(1)
    fut = cli.call_async(srv_type.Request(**fields))
    rclpy.spin_until_future_complete(node, fut)
    node.destroy_client(cli)
    return fut.result()


call(SetPen, '/turtle1/set_pen', r=255, g=0, b=0, width=3, off=1)
cx = cy = 5.5
R = 3.0
corners = [(cx + R * math.sin(k * 4 * math.pi / 5), cy + R * math.cos(k * 4 * math.pi / 5)) for k in range(6)]
for n, (x, y) in enumerate(corners):
    call(TeleportAbsolute, '/turtle1/teleport_absolute', x=x, y=y, theta=0.0)
    log.info('corner %d' % n)
    if n == 0:
        call(SetPen, '/turtle1/set_pen', r=255, g=0, b=0, width=3, off=0)
        call(Empty, '/clear')
call(SetPen, '/turtle1/set_pen', r=0, g=0, b=0, width=1, off=1)
call(TeleportAbsolute, '/turtle1/teleport_absolute', x=2.0, y=3.0, theta=1.0)
log.info('star drawn')
node.destroy_node()
rclpy.shutdown()
