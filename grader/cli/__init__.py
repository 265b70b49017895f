"""The commands of ``grader``. A user's mistake ends a command with one clear line and exit code 2."""
