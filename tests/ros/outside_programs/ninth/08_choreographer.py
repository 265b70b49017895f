"""A dance of turtles, directed by a service whose callback is a coroutine that awaits turtlesim's own services."""

import math
import sys

import rclpy
from geometry_msgs.msg import Twist
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from std_srvs.srv import Empty, Trigger
from turtlesim.msg import Color, Pose
from turtlesim.srv import Kill, SetPen, Spawn, TeleportAbsolute, TeleportRelative


class Choreographer(Node):
    def __init__(self):
        super().__init__("choreographer")
        self.group = MutuallyExclusiveCallbackGroup()
        self.spawn = self.make_client(Spawn, "/spawn")
        self.kill = self.make_client(Kill, "/kill")
        self.clear = self.make_client(Empty, "/clear")
        self.create_service(Trigger, "dance", self.on_dance)
        self.poses, self.colours = {}, {}
        self.listen("turtle1")

    def make_client(self, kind, name):
        client = self.create_client(kind, name, callback_group=self.group)
        while not client.wait_for_service(timeout_sec=1.0):
            self.get_logger().info(f"{name} is not there yet")
        return client

    def listen(self, name):
        self.create_subscription(Pose, f"/{name}/pose", lambda pose: self.poses.update({name: pose}), 10)
        self.create_subscription(
            Color, f"/{name}/color_sensor", lambda colour: self.colours.update({name: colour}), 10
        )

    async def on_dance(self, request, response):
        dancers = ["turtle1"]
        for i in range(3):
            angle = math.tau * i / 3
            answer = await self.spawn.call_async(
                Spawn.Request(x=5.5 + 2 * math.cos(angle), y=5.5 + 2 * math.sin(angle), theta=angle, name=f"d{i}")
            )
            self.listen(answer.name)
            dancers.append(answer.name)
        again = await self.spawn.call_async(Spawn.Request(x=1.0, y=1.0, name="d0"))
        self.get_logger().info(f"a second d0 is called {again.name!r}")
        await self.kill.call_async(Kill.Request(name="turtle1"))
        dancers.remove("turtle1")
        for i, name in enumerate(dancers):
            pen = self.make_client(SetPen, f"/{name}/set_pen")
            await pen.call_async(SetPen.Request(r=255, g=40 * i, b=0, width=3, off=0))
            relative = self.make_client(TeleportRelative, f"/{name}/teleport_relative")
            await relative.call_async(TeleportRelative.Request(linear=1.0, angular=math.pi / 2))
        await self.clear.call_async(Empty.Request())
        absolute = self.make_client(TeleportAbsolute, "/d2/teleport_absolute")
        await absolute.call_async(TeleportAbsolute.Request(x=2.0, y=9.0, theta=0.0))
        response.success = True
        response.message = ", ".join(dancers)
        return response


class Director(Node):
    def __init__(self, choreographer):
        super().__init__("director")
        self.stage = choreographer
        self.client = self.create_client(Trigger, "dance", callback_group=MutuallyExclusiveCallbackGroup())
        self.cmd = self.create_publisher(Twist, "/d2/cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.direct)
        self.ticks = 0
        self.done = rclpy.task.Future()

    async def direct(self):
        self.timer.cancel()
        answer = await self.client.call_async(Trigger.Request())
        self.get_logger().info(f"dancing: {answer.message}")
        self.move = self.create_timer(0.1, self.go)

    def go(self):
        self.ticks += 1
        if self.ticks <= 20:
            self.cmd.publish(Twist())
            command = Twist()
            command.linear.x = 1.0
            self.cmd.publish(command)
        elif self.ticks == 40:
            pose, colour = self.stage.poses["d2"], self.stage.colours["d2"]
            self.get_logger().info(f"d2 at {pose.x:.1f} {pose.y:.1f}, on {colour.r} {colour.g} {colour.b}")
            self.done.set_result(3)


def main():
    rclpy.init(args=sys.argv)
    choreographer = Choreographer()
    director = Director(choreographer)
    executor = MultiThreadedExecutor()
    executor.add_node(choreographer)
    executor.add_node(director)
    try:
        executor.spin_until_future_complete(director.done)
        sys.exit(director.done.result())
    finally:
        choreographer.destroy_node()
        director.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
