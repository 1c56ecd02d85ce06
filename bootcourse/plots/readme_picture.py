"""The picture of the README: two drives on the same road, one that stays in the trap and one that leaves it.

    python -m bootcourse.plots.readme_picture                            # doing nothing, and the rule
    python -m bootcourse.plots.readme_picture stays.npz leaves.npz       # two recorded drives

The drives come from `bootcourse drive`. Writes trap.gif and trap.png into assets/readme (--out: elsewhere).
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError
from bootcourse.plots.animation import animate, frame
from bootcourse.plots.figure import save
from bootcourse.policies import idle_policy, rule_policy
from bootcourse.road.state import EGO, LANE
from bootcourse.scenario import DEFAULT

ROAD = 3  # our choice: the rule passes after 22 s there, so the clip is short
FOLDER = Path(__file__).resolve().parents[2] / "assets" / "readme"


def readme_still(top: Rollout, bottom: Rollout, path: Path) -> Path:
    """The moment that says it all: the lower car crosses into another lane, behind the traps. Returns the path."""
    crossed = np.flatnonzero(np.diff(bottom.states[:, EGO, LANE]))
    return save(frame([top, bottom], float(bottom.times[crossed[0] + 1]) if crossed.size else 0.0), path)


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m bootcourse.plots.readme_picture", description=__doc__.split("\n")[0]
    )
    parser.add_argument("drives", nargs="*", type=Path, help="two rollouts (.npz): the upper and the lower one")
    parser.add_argument("--out", type=Path, default=FOLDER, help="the folder to write into (default: assets/readme)")
    options = parser.parse_args(arguments)
    try:
        if len(options.drives) not in (0, 2):
            raise BootcourseError(f"{len(options.drives)} drives: give two, the upper and the lower one, or none.")
        if options.drives:
            top, bottom = map(Rollout.load, options.drives)
        else:
            top = record(idle_policy, [ROAD], DEFAULT, "idle")[0]
            bottom = record(rule_policy(DEFAULT), [ROAD], DEFAULT, "rule")[0]
        print(animate([top, bottom], options.out / "trap.gif"))
        print(readme_still(top, bottom, options.out / "trap.png"))
    except BootcourseError as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
