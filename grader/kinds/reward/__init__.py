"""The kind of submission ``reward``."""
