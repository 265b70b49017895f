"""Drives of a robot, for every kind whose program drives one: their episodes, records and checks."""
