"""Programs of demo_nodes_py."""
