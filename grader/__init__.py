"""The autograder: runs a student's program in another process and grades what it was seen to do.

Nothing of a student's is imported, unpickled or collected in this process. The program only publishes messages or
returns values; the world, the seeds, the recordings, the checks and the points are the grader's.
"""
