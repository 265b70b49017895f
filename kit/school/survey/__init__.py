"""The evaluation form: what is asked of a student before and after the lessons, and what they said."""
