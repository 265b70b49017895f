"""Training runs: learners, settings, schedules, files on disk."""
