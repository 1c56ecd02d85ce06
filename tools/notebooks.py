"""Make the notebooks from the lessons' texts: `python tools/notebooks.py [NAME ...] [--prose | --check | --solved]`.

bootcourse/course/lessons/NAME/text.py is the one that people edit (percent format, readable diffs; the README beside
the folders says how). Each becomes an executed notebook for the student. All cores work at once. A lesson that fails is
named at the end, and its notebook stays as it was.
--prose executes nothing where only the text between the code has changed.
--check writes nothing: it says what is wrong with the texts and with what was made from them.
--solved executes nothing: it writes the notebooks with the solutions and the instructor's pages, notebooks/solved and
notebooks/instructor, with the outputs of the students' notebooks.
"""

import argparse
import os
import sys
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))  # so that `tools.course` is found
os.environ.setdefault("OMP_NUM_THREADS", "1")  # or two kernels with two torches fight over the cores

from bootcourse.processes import usable_processors
from bootcourse.web import bundle
from tools.course import products
from tools.course.numbering import refresh_kept
from tools.course.problems import problems
from tools.course.source import lesson_of, sources


def make(path: Path, prose: bool) -> Path:
    """Make the notebook of a text, executing nothing if `prose` and that is enough. Returns what is written."""
    return (prose and products.refresh_prose(path)) or products.make(path)


def make_all(paths: list[Path], prose: bool) -> bool:
    """Make the notebooks of these texts, the longest first. Returns whether all were made."""
    fine = True
    bundle.content()  # or each notebook with a road would compile it, and say so
    with ProcessPoolExecutor(usable_processors()) as workers:
        paths = sorted(paths, key=lambda path: -path.stat().st_size)
        running = {workers.submit(make, path, prose): path for path in paths}
        for done in as_completed(running):
            if error := done.exception():
                fine = False
                print(f"{lesson_of(running[done])} failed: {error}", file=sys.stderr)
            else:
                print(done.result(), flush=True)
    return fine


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="such as the_rule; without one, every lesson")
    only = parser.add_mutually_exclusive_group()
    for flag in ("--prose", "--check", "--solved"):
        only.add_argument(flag, action="store_true")
    asked = parser.parse_args(arguments)
    paths = sources(asked.names)
    if asked.check:
        wrong = [f"{lesson_of(path)}: {problem}" for path in paths for problem in problems(path)]
        print("\n".join(wrong) or "Nothing is wrong.")
        return bool(wrong)
    if asked.solved:
        print(*(file for path in paths for file in products.make_solved(path)), sep="\n")
        return 0
    fine = make_all(paths, asked.prose)
    if fine and not asked.names:
        for path in products.remove_strange():
            print(f"{path} is removed: no lesson has this number.")
        refresh_kept()
    return not fine


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
