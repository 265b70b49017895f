"""The school: lessons, quiz, evaluation form, a class's report, and the game around them."""
