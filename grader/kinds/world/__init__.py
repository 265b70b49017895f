"""The kind of submission ``world``."""
