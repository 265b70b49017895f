from kit.msg.action_msgs import CancelGoal as CancelGoal
