"""The verbs of ``grader``. A user's mistake ends a verb with one clear line and exit code 2."""
