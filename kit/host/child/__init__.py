"""The child's side: what runs in a student's process. ``bootstrap`` is the first of it and starts the rest.

Nothing here is imported in the kit's own process.
"""
