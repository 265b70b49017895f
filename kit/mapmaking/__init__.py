"""Makes maps from a photograph of a drawing, or from a text of walls and spaces."""
