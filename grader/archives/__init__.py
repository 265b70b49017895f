"""Submitted archives: each format a module; what they hold becomes names and bytes, and nothing is extracted to disk."""
