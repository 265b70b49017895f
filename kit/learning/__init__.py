"""Learning: tasks, environments, training."""
