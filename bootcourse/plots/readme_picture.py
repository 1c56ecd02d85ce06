"""The picture of the README: two drives on the same road, one that stays in the trap and one that leaves it.

    python -m bootcourse.plots.readme_picture

It writes trap.gif and trap.png into assets/readme.
"""

from pathlib import Path

from bootcourse.episodes.record import record
from bootcourse.plots.animation import animate, key_frame
from bootcourse.plots.figure import save
from bootcourse.policies import idle_policy, rule_policy
from bootcourse.scenario import DEFAULT

ROAD = 3  # our choice: the rule passes after 22 s there, so the clip is short
FOLDER = Path(__file__).resolve().parents[2] / "assets" / "readme"


def main(folder: Path = FOLDER) -> None:
    """Record both drives and draw them."""
    stays = record(idle_policy, [ROAD], DEFAULT, "idle")[0]
    leaves = record(rule_policy(DEFAULT), [ROAD], DEFAULT, "rule")[0]
    print(animate([stays, leaves], folder / "trap.gif"))
    print(save(key_frame([stays, leaves]), folder / "trap.png"))


if __name__ == "__main__":
    main()
