"""What the research adds to the command line and to the studies, and where it is (see rooms.py)."""

_HERE = "bootcourse.research"
COMMANDS = {"study": f"{_HERE}.commands:study", "assets": f"{_HERE}.commands:assets"}
TEACHERS = {"of the studies": f"{_HERE}.teachers:TEACHERS"}
EXPERIMENTS = {  # in the order of the report
    "sensitivity": f"{_HERE}.experiments.sensitivity",
    "clocks": f"{_HERE}.experiments.clocks",
    "ablations": f"{_HERE}.experiments.ablations",
    "longer-view": f"{_HERE}.experiments.longer_view",
    "beyond": f"{_HERE}.experiments.beyond",
    "beyond-search": f"{_HERE}.experiments.beyond_search",
    "others": f"{_HERE}.experiments.others",
    "stress": f"{_HERE}.experiments.stress",
    "teachers": f"{_HERE}.experiments.teacher_worth",
    "look-ahead": f"{_HERE}.experiments.lookahead",
    "learned-model": f"{_HERE}.experiments.learned_model",
    "elsewhere": f"{_HERE}.experiments.elsewhere",
    "checks": f"{_HERE}.experiments.checks",
}
