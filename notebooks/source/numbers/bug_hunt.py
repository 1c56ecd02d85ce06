"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

from bootcourse.course.lessons.bug_hunt import bugs

hunt = cache(bugs.Hunt)  # the agents of the bug hunt
