"""The kind of submission ``launch``."""
