"""A report format a file, with its ``FORMAT``; ``grader.reports`` finds them here."""
