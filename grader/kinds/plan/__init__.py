"""The kind of submission ``plan``."""
