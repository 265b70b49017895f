"""What screens show, as rows of text: pure functions, no Textual."""
