"""Hostile tests: damaged files, killed commands, foreign pages. `python -m tests.hostile` runs all of them."""
