"""The results of grading: what the grader writes, and the screens, the line mode and all reports read and show."""
