"""Keeps pytest from the outside programs, some of which are tests of their own: ``test_outside_programs`` runs them."""

collect_ignore_glob = ["*/*"]
