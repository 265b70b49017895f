"""Floor 6: the dissertation's experiments, as runs that anyone can repeat."""
