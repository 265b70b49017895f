"""The services of ROS 2's package std_srvs."""

from kit.msg.fields import boolean, string, zero
from kit.msg.message import Message, Service


class Empty(Service):
    class Request(Message):
        pass

    class Response(Message):
        pass


class SetBool(Service):
    class Request(Message):
        data: boolean = zero

    class Response(Message):
        success: boolean = zero
        message: string = zero


class Trigger(Service):
    class Request(Message):
        pass

    class Response(Message):
        success: boolean = zero
        message: string = zero
