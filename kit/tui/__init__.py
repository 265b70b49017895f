"""The full-screen user interface. Only modules below this one import Textual, after the terminal was examined."""
