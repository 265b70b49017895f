"""Grades a whole class by a queue folder of jobs and results, which any number of processes share.

A job's key is a digest of what decides its result: submission, assignment, grader, seeds, level. Its result is one file,
written atomically. So an interrupted grading continues where it was, nothing is graded twice, and shards, array jobs and
clusters need no coordination.
"""
