"""A case and its layers in characters, in which no meaning hangs on colour."""
