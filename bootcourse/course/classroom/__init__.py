"""A class: handing lessons out, collecting answers, grading them, and pages about what went wrong.

A student's text is data here. It is executed in one place only, the judge's own process for it (`course/runner.py`),
which `sandbox.py` has shut in.
"""
