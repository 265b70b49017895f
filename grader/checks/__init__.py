"""Checks: functions that measure evidence. A function's docstring is the feedback for lost points, its name the check's."""
