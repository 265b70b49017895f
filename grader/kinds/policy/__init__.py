"""The kind of submission ``policy``."""
