from kit.msg.nav_msgs import GetMap as GetMap
from kit.msg.nav_msgs import GetPlan as GetPlan
from kit.msg.nav_msgs import LoadMap as LoadMap
from kit.msg.nav_msgs import SetMap as SetMap
