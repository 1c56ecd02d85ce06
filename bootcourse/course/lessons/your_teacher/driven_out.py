"""How a rule is judged: it drives a road to the end, and a sentence says what went wrong on how many of them."""

import numpy as np

from bootcourse.course.values import NUMERIC, plain
from bootcourse.learn.teachers import is_action
from bootcourse.road import twin
from bootcourse.road.constants import constants
from bootcourse.road.state import EGO, LANE, TRAP_1, X
from bootcourse.scenario import N_ACTIONS

OUT, BEHIND, OUTSIDE, NOT_SAME, NOT_WHOLE, NOTHING, SLOW = 0, 4, 5, 6, 7, 8, 9  # 1 to 3 are the accidents
ENDINGS = {1: "collides", 2: "leaves the road", 3: "stops on the road", BEHIND: "is still behind trap 1 at the end"}
ENDINGS[SLOW] = "is in the left lane, and too slow to be ahead of trap 1 at the end"

CHANGES = (
    "Your rule answers the same road differently when it is asked again: it draws at random, or remembers. The label "
    "of a state must not change."
)


def drive_out(answer, cars, scenario):
    """How one road ends: 0 for ahead of trap 1 at the end, without an accident, else what went wrong.

    An answer that is not a number is returned unchanged.
    """
    road, c = cars[None].copy(), constants(scenario)  # of one road, without what an environment does besides
    accident, asleep, (rewards, terms) = np.zeros(1, np.int64), np.zeros(1, bool), (np.zeros(1), np.zeros((1, 3)))
    asked = []
    while accident[0] == twin.NO_ACCIDENT and len(asked) < scenario.clock.decisions:
        seen = road[0].copy()
        action = answer(seen.copy() if asked else cars, scenario)  # its own array, so that the check sees a change
        wrong = no_action(action)
        if wrong == NOTHING and not asked:
            return None
        if wrong is not None:
            return action if wrong == "as it is" else wrong
        asked.append((seen, int(action)))
        twin.decide(road, np.array([int(action)]), asleep, c, rewards, terms, accident, twin.NO_TRACE)
    if any(not same_action(answer(seen.copy(), scenario), action) for seen, action in reversed(asked)):
        return NOT_SAME
    if accident[0] != twin.NO_ACCIDENT:
        return int(accident[0])
    if road[0, EGO, X] > road[0, TRAP_1, X]:
        return OUT
    return SLOW if road[0, EGO, LANE] == 0 else BEHIND


def same_action(again, action: int) -> bool:
    """Does a rule that is asked a second time, after its drive, give the same action?"""
    return no_action(again) is None and int(again) == action


def no_action(action):
    """What is wrong with an answer of the rule; None if nothing is."""
    if type(action) is int and 0 <= action < N_ACTIONS:  # most are: it takes no time
        return None
    if action is None:
        return NOTHING
    if plain(action).kind not in NUMERIC or plain(action).shape != ():
        return "as it is"
    if not is_action(action):
        return OUTSIDE if np.asarray(action).dtype.kind in "iu" else NOT_WHOLE
    return None


def explain_rule(cases, answers):
    """What went wrong on how many of the roads."""
    ends = [int(answer) for answer in answers]
    if NOTHING in ends:
        return "Your rule returns nothing in some situations: look for a branch without `return`."
    if NOT_WHOLE in ends:
        return "Your rule returns another kind of number: an action is a whole number (an `int`), 0 to 8."
    if OUTSIDE in ends:
        return f"Your rule sometimes returns a number that is not an action: give a whole number, 0 to {N_ACTIONS - 1}."
    if NOT_SAME in ends:
        return CHANGES
    failures = ", on ".join(f"{ends.count(end)} it {words}" for end, words in ENDINGS.items() if end in ends)
    return f"Your rule gets out on {ends.count(OUT)} of {len(ends)} roads; on {failures}."
