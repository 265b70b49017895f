"""Launch files in XML and YAML: elements with their places, the substitutions in their texts, the actions they stand for."""
