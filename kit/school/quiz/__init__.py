"""The quiz: twelve ideas, and a bank of questions over all lessons that come back after 1, 3, 7 and 21 days."""
