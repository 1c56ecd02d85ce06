"""What we claim, and what it survived: the sentences that a reader will repeat, each with its evidence and its stress.

The claims themselves stand in `claimed.py`. `section` is the report's part about them.
"""

from dataclasses import dataclass, field

import numpy as np

from bootcourse.research import tables
from bootcourse.statistics import ESCAPES, holm, rate


@dataclass(frozen=True)
class Claim:
    """One sentence. It stands as long as all attempts to refute it have failed."""

    name: str
    sentence: str
    evidence: str
    stress: dict[str, tuple[bool, str]]  # {what was tried: (it still holds, what was seen)}
    p: float | None = None  # of Fisher's exact test, two-sided, where two groups of agents are compared
    also: list[str] = field(default_factory=list)  # what it does not say

    @property
    def stands(self) -> bool:
        """Has it survived all of its stress?"""
        return all(holds for holds, _ in self.stress.values())


def section(made: list[Claim]) -> list[str]:
    """The report's part: every claim with its evidence, its stress, and Holm's p over the family."""
    compared = [claim for claim in made if claim.p is not None]
    adjusted = dict(zip((claim.name for claim in compared), holm([claim.p for claim in compared]), strict=True))
    four = rate(np.arange(10) < 4)
    head = HEAD.format(claims=len(made), compared=len(compared), escapes=ESCAPES, four=four)
    text = ["## What we claim, and what it survived\n", head]
    for claim in made:
        text += [f"### {claim.sentence}\n", *of_claim(claim, adjusted.get(claim.name))]
    return text


def of_claim(claim: Claim, adjusted: float | None = None) -> list[str]:
    """Its evidence, and what was tried to refute it. adjusted: Holm's p value, where groups of agents are compared."""
    rows = [[what, "holds" if holds else "**falls**", seen] for what, (holds, seen) in claim.stress.items()]
    text = [f"*Evidence:* {claim.evidence}.\n", tables.markdown(["tried", "", "seen"], rows)]
    text += [f"Fisher's p, adjusted by Holm: {adjusted:.2g}.\n"] if adjusted is not None else []
    text += [f"{words}\n" for words in claim.also]
    return text + ["**Not all of it holds: take it as an open question.**\n"] * (not claim.stands)


HEAD = """These {claims} sentences are the ones to repeat. Each was attacked: with twice the episodes, other seeds and
another implementation of the learner (ten agents of each kind), with other traps, other roads, somebody else's learner
or half the time step. *Escape*: ahead of trap 1 on at least {escapes:.0%} of 1,000 held-out roads. The return and the
accidents stand beside the success. Where two groups of agents are compared, the p value is Holm's over these
{compared}. *Holds*: what was seen points the same way. That is weaker than evidence of its own: four of ten agents, as
an example, have the 95 % interval {four[1]:.0%} to {four[2]:.0%} (Clopper-Pearson).
"""
