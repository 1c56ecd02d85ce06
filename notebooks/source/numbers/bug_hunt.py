"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

from bootcourse.course.lessons.bug_hunt import bugs

hunt = cache(bugs.Hunt)  # the agents of the bug hunt


def seeds_of(name: str) -> str:
    """An agent's success at the end of training, in %: "80 and 0", of its two seeds."""
    return " and ".join(f"{100 * value:.0f}" for value in hunt().at_the_end("success")[name])
