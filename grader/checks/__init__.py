"""Checks: each is one function whose docstring is the feedback. A new one is a function here and its name in a table."""
