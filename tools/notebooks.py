"""Make the notebooks from their sources: `python tools/notebooks.py [NAME ...] [--prose | --check | --claims]`.

notebooks/source/NAME.py is the one that people edit (percent format, readable diffs; its README says
how). Each becomes notebooks/NAME.ipynb for the student, notebooks/solved/NAME.ipynb with the solutions,
both executed, and notebooks/instructor/NAME.md.
--prose executes nothing where only the text between the code has changed.
--check writes nothing: it says what is wrong with the sources and with what was made from them.
--claims writes nothing: it prints the sentences about all cases (never, only, because ...) that have no claim.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))  # so that `tools.course` is found

from tools.course.claims import unclaimed
from tools.course.problems import problems
from tools.course.products import make, refresh_prose
from tools.course.source import sources


def main(arguments: list[str]) -> int:
    names = [a for a in arguments if not a.startswith("--")]
    if "--check" in arguments:
        found = [f"{path.stem}: {problem}" for path in sources(names) for problem in problems(path)]
        print("\n".join(found) or "Nothing is wrong.")
        return bool(found)
    if "--claims" in arguments:
        print(*(f"{path.stem}: {sentence}" for path in sources(names) for sentence in unclaimed(path)), sep="\n")
        return 0
    for path in sources(names):
        if not ("--prose" in arguments and refresh_prose(path)):
            print(*make(path), sep="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
