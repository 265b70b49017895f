"""The full-screen face. Textual is imported only by modules below this one, after the terminal was looked at."""
