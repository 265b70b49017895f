from kit.msg.example_interfaces import Fibonacci as Fibonacci
