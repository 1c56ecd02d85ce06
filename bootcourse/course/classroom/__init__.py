"""A class: handing lessons out, collecting answers, grading them, and pages about what went wrong.

A student's text is data here. It is executed in one place only, `runner.py`, in a process shut in by `sandbox.py`.
"""
