from kit.msg.action_msgs import GoalInfo as GoalInfo
from kit.msg.action_msgs import GoalStatus as GoalStatus
from kit.msg.action_msgs import GoalStatusArray as GoalStatusArray
