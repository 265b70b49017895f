from kit.msg.ackermann_msgs import AckermannDrive as AckermannDrive
from kit.msg.ackermann_msgs import AckermannDriveStamped as AckermannDriveStamped
