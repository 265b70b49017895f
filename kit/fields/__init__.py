"""Artificial potential fields: charges on a map, the pair that follows them, and a planner that needs no luck."""
