"""The kind of submission ``environment``."""
