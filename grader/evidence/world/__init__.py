"""A world that was handed in: read and run in a process that can be ended, told to the grader as plain records."""
