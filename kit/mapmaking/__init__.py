"""Maps of one's own: from a photograph of a drawing, or from a text of walls and spaces."""
