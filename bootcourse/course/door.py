"""What the course adds to the front door, the command line and the studies, and where it is (see rooms.py)."""

_HERE = "bootcourse.course"
NAMES = {  # what ships with the course
    "shipped_results": f"{_HERE}.shipped",
    "shipped_agents": f"{_HERE}.shipped",
    "shipped_drive": f"{_HERE}.shipped",
    "board": f"{_HERE}.board",
}
COMMANDS = {name: f"{_HERE}.classroom.commands:{name}" for name in ("handout", "submit", "grade")}
EXPERIMENTS = {  # of the lessons
    "clones": f"{_HERE}.lessons.demonstrations.fifteen",
    "bug-hunt": f"{_HERE}.lessons.bug_hunt.bugs",
    "students": f"{_HERE}.lessons.your_teacher.taught_agents",
    "crashes": f"{_HERE}.lessons.your_teacher.crashes",
    "second-trap": f"{_HERE}.lessons.the_second_trap.ppo_kinds",
    "easier": f"{_HERE}.lessons.the_barrier.easier",
    "reachable-entropy": f"{_HERE}.lessons.recorded_drives.reachable_entropy",
    "ways": f"{_HERE}.lessons.found_and_kept.ways",
    "pole": f"{_HERE}.lessons.update_and_loop.pole",
    "new-agents": f"{_HERE}.lessons.how_many_seeds.new_agents",
    "offline": f"{_HERE}.lessons.recorded_drives.eight_seeds",
    "unpaid": f"{_HERE}.lessons.your_own_problem.unpaid",
}
