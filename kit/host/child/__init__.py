"""The code that runs in a student's process: ``supervisor`` comes first and starts the rest.

Nothing here is imported in the kit's own process.
"""
