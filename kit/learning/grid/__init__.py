"""Worlds of square cells in which lessons show learning, and the learners: each algorithm is one file."""
