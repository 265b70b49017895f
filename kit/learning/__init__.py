"""Learning: tasks as environments, training, policies. ``import kit`` registers the environments with Gymnasium."""
