"""The tables of the bug hunt: how the agents drive after training, and how they agree with the rule early in it."""

import numpy as np

from bootcourse.course.lessons.bug_hunt.bugs import Hunt
from bootcourse.episodes.evaluate import Episodes, drive_episodes, held_out_seeds
from bootcourse.learn.settings import settings_for

DRIVEN = [
    "200 roads",
    "success, most probable, %",
    "success, drawn, %",
    "return, most probable",
    "accidents, most probable, %",
]
AGREEMENT = ["early in training, both seeds", "as the rule does now, %", "as it does one second later, %"]
EARLY = slice(2, 6)  # of the probes: after 500 to 1,250 updates
TITLES = {  # of the pictures; here, so that the student's cell does not give away what it answers
    "success": "Four of the six agents with a bug succeed in training",
    "end": "One agent values its own accidents far below −10",
    "promise": "Two agents promise far more than the healthy one",
    "rarest": "Two agents keep their rarest action far likelier than the healthy one",
}


def most() -> float:
    """What the road pays at most, about 1 a second for ever, discounted."""
    return 1 / (1 - settings_for("bootstrapped").gamma)


def drives(hunt: Hunt, name: str, drawn: bool = False) -> Episodes:
    """200 drives of an agent's first seed, by its most probable actions or by drawn ones."""
    policy = hunt.agent(name).as_policy(np.random.default_rng(0) if drawn else None)
    return drive_episodes(policy, held_out_seeds(12, 200))


def driven(hunt: Hunt) -> list[list[str]]:
    """A row for each agent; return and accidents are those of its most probable actions."""
    rows = []
    for name in hunt.names:
        likeliest, drawn = drives(hunt, name), drives(hunt, name, drawn=True)
        shares = (likeliest.success, drawn.success, likeliest.accident > 0)
        greedy, sampled, crashed = (f"{100 * share.mean():.0f}" for share in shares)
        rows.append([name, greedy, sampled, f"{likeliest.returns.mean():.0f}", crashed])
    return rows


def agreement(hunt: Hunt) -> list[list[str]]:
    """How often each agent's most probable action is the rule's, now and one second later: means over two seeds."""
    probes = ("alike", "late")
    return [[name, *(f"{100 * hunt.probe(name, what)[:, EARLY].mean():.0f}" for what in probes)] for name in hunt.names]
