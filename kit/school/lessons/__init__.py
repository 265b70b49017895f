"""Lessons: folders of data, read strictly; exercises laid out in the student's workspace and checked by the grader."""
