"""Drawing the world: a plain scene, a camera, and encoders that turn both into rows of characters or pixels.

Pure: it knows no terminal and no interface. What a running simulation looks like is put into a
``Scene`` by whoever watches it; what becomes of a ``Frame`` is the business of the faces.
"""
