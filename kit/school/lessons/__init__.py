"""Lessons: folders of data, read strictly; exercises installed in the student's workspace and checked by the grader."""
