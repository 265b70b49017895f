"""A whole class: a queue folder of jobs and results, whoever works it off.

A job is named by what decides its result: submission, assignment, grader, seeds, level. Its result is one file, written
whole or not at all. So whatever is interrupted goes on where it was, what was graded before is not graded again, and
shards, array jobs and clusters need to agree on nothing.
"""
