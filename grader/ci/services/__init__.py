"""A CI service a file, with its ``SERVICE``; ``grader.ci`` finds them here."""
