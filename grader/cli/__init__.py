"""The verbs of ``grader``, one module each, and how a user's mistake ends: one clear line and exit code 2."""
