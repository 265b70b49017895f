from kit.msg.actionlib_msgs import GoalID as GoalID
from kit.msg.actionlib_msgs import GoalStatus as GoalStatus
from kit.msg.actionlib_msgs import GoalStatusArray as GoalStatusArray
