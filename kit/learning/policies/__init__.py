"""Trained policies: arrays, evaluation, and deployment as a node."""
