from kit.msg.lifecycle_msgs import ChangeState as ChangeState
from kit.msg.lifecycle_msgs import GetAvailableStates as GetAvailableStates
from kit.msg.lifecycle_msgs import GetAvailableTransitions as GetAvailableTransitions
from kit.msg.lifecycle_msgs import GetState as GetState
