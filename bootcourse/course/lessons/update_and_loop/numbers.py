"""What the text of the lesson on SAC's update and loop names: the agent with its first α."""

from bootcourse.course.lessons.update_and_loop import by_hand  # noqa: F401 (the text names it)
