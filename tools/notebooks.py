"""Make the notebooks from their sources: `python tools/notebooks.py [NAME ...] [--prose | --check | --claims]`.

notebooks/source/NAME.py is the one that people edit (percent format, readable diffs; its README says
how). Each becomes notebooks/NAME.ipynb for the student, notebooks/solved/NAME.ipynb with the solutions,
both executed, and notebooks/instructor/NAME.md.
--prose executes nothing where only the text between the code has changed.
--check writes nothing: it says what is wrong with the sources and with what was made from them.
--claims writes nothing: it prints the sentences about all cases (never, only, because ...) that have no claim.
"""

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))  # so that `tools.course` is found

from tools.course.claims import unclaimed
from tools.course.problems import problems
from tools.course.products import make, refresh_prose
from tools.course.source import sources


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="such as 09_ablation; without one, every lesson")
    only = parser.add_mutually_exclusive_group()
    for flag in ("--prose", "--check", "--claims"):
        only.add_argument(flag, action="store_true")
    asked = parser.parse_args(arguments)
    if asked.check:
        found = [f"{path.stem}: {problem}" for path in sources(asked.names) for problem in problems(path)]
        print("\n".join(found) or "Nothing is wrong.")
        return bool(found)
    if asked.claims:
        print(*(f"{path.stem}: {sentence}" for path in sources(asked.names) for sentence in unclaimed(path)), sep="\n")
        return 0
    for path in sources(asked.names):
        if not (asked.prose and refresh_prose(path)):
            print(*make(path), sep="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
