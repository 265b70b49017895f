"""A class's report: what its students knew, answered, found hard and got right, from the files they exported."""
