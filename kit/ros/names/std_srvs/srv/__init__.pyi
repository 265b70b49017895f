from kit.msg.std_srvs import Empty as Empty
from kit.msg.std_srvs import SetBool as SetBool
from kit.msg.std_srvs import Trigger as Trigger
