from kit.msg.stereo_msgs import DisparityImage as DisparityImage
