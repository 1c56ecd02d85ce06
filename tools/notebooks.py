"""Make the notebooks from their sources: `python tools/notebooks.py [NAME ...] [--prose | --check]`.

notebooks/source/NAME.py is the one that people edit (percent format, readable diffs; its README says
how). Each becomes a notebook for the student, one with the solutions in notebooks/solved, both executed, and a page in
notebooks/instructor. All cores work at once. A lesson that fails is named at the end, and its files stay as they were.
--prose executes nothing where only the text between the code has changed.
--check writes nothing: it says what is wrong with the sources and with what was made from them.
"""

import argparse
import os
import sys
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))  # so that `tools.course` is found
os.environ.setdefault("OMP_NUM_THREADS", "1")  # or two kernels with two torches fight over the cores

from bootcourse.processes import usable_processors
from tools.course import products
from tools.course.numbering import refresh_kept
from tools.course.problems import problems
from tools.course.source import sources


def make(path: Path, prose: bool) -> list[Path]:
    """Make the files of a source, without executing anything if `prose` and that is enough. Returns what is written."""
    return (prose and products.refresh_prose(path)) or products.make(path)


def make_all(paths: list[Path], prose: bool) -> bool:
    """Make the files of these sources, the longest first. Returns whether all were made."""
    fine = True
    with ProcessPoolExecutor(usable_processors()) as workers:
        paths = sorted(paths, key=lambda path: -path.stat().st_size)
        running = {workers.submit(make, path, prose): path for path in paths}
        for done in as_completed(running):
            if error := done.exception():
                fine = False
                print(f"{running[done].stem} failed: {error}", file=sys.stderr)
            else:
                print(*done.result(), sep="\n", flush=True)
    return fine


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="such as the_rule; without one, every lesson")
    only = parser.add_mutually_exclusive_group()
    for flag in ("--prose", "--check"):
        only.add_argument(flag, action="store_true")
    asked = parser.parse_args(arguments)
    paths = sources(asked.names)
    if asked.check:
        wrong = [f"{path.stem}: {problem}" for path in paths for problem in problems(path)]
        print("\n".join(wrong) or "Nothing is wrong.")
        return bool(wrong)
    fine = make_all(paths, asked.prose)
    if fine and not asked.names:
        for path in products.remove_strange():
            print(f"{path} is removed: no lesson has this number.")
        refresh_kept()
    return not fine


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
