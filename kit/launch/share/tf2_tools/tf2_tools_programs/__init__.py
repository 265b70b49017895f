"""Programs of tf2_tools."""
