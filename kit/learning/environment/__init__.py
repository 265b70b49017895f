"""Tasks as environments: observations, actions, rewards, and the batch engine."""
