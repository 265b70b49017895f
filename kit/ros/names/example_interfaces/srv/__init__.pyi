from kit.msg.example_interfaces import AddTwoInts as AddTwoInts
from kit.msg.example_interfaces import SetBool as SetBool
from kit.msg.example_interfaces import Trigger as Trigger
