from kit.msg.builtin_interfaces import Duration as Duration
from kit.msg.builtin_interfaces import Time as Time
