"""The version of the package, which is that of the program. A test compares the two."""

__version__ = "0.2.0"
