"""One part of each group."""
