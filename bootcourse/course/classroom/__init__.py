"""A class: handing lessons out, collecting answers, grading them, and pages about what went wrong.

A student's text is data here. It is executed in one place only, `answer_process.py`, in a process that `sandbox.py`
shuts in.
"""
