"""Artificial potential fields: charges on a map, controllers for one robot or a pair, and a path planner."""
