"""The number in the text of the lesson on SAC's update and loop: how soon a pole falls that is pushed to one side."""

from bootcourse.course.lessons.update_and_loop import left_out

PUSHES = [len(states) - 1 for states in left_out.to_one_side()]
