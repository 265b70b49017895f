"""A teacher's own tests for points: how they are read, run and turned into results."""
