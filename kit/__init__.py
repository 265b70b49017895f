"""The terminal robot-learning kit. The loop is in ``kit/run/runner.py``; the house is drawn in ``README.md``."""

__version__ = "0.1.0"
