from kit.msg.sensor_msgs import SetCameraInfo as SetCameraInfo
