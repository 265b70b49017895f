from kit.msg.action_tutorials_interfaces import Fibonacci as Fibonacci
