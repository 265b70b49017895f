"""Goals of a task: each is one file with one subclass of ``Goal``, found by its ``kind``."""
