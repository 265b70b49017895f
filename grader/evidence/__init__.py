"""Evidence for grading: running submissions and recording what they do."""
