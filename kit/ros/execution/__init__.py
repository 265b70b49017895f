"""Running callbacks: contexts, executors, tasks and callback groups."""
