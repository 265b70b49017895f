"""Programs of tf2_ros."""
