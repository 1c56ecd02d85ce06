"""A way out without braking: how a student's plan is driven, and what the check says about it."""

import numpy as np

from bootcourse.course.exercise import NotAsAsked, refuse
from bootcourse.episodes.record import record
from bootcourse.errors import BootcourseError
from bootcourse.policies import plan_policy
from bootcourse.road.state import Accident

ROADS = (7, 3, 5, 8, 11, 12, 13, 15)  # on each of them trap 2 starts 4.85 m ahead or more
EARLY = 15  # s; an accident until then is the plan's own, not the traffic's


def direct_plan():
    """Our own plan, in words."""
    steering = [("keep left", 2), "keep right", "keep left", ("keep right", 3), "keep left"]
    return [*steering, ("accelerate straight", 5)]


def drive_plan(answer, road):
    """[seconds with the brake, the kind of an accident in the first 15 s, ends ahead of trap 1] on a road."""
    plan = answer()
    if not isinstance(plan, (list, tuple)):
        return refuse(plan, 'a list of actions in words, such as ["keep left", ("keep right", 2)]')
    try:
        policy = plan_policy(list(plan))
    except BootcourseError as error:
        raise NotAsAsked(f"Your plan cannot be driven: {error}") from error
    except (TypeError, ValueError):
        wanted = 'an action in words, "keep left", or such an action with its seconds, ("keep right", 2)'
        raise NotAsAsked(f"Your plan cannot be driven: each of its parts is {wanted}.") from None
    drive = record(policy, [road])[0]
    early = drive.accident if drive.times[-1] <= EARLY else 0
    return np.array([(drive.actions // 3 == 0).sum(), early, drive.success], dtype=float)


def what_happened(cases, answers):
    """A sentence on a plan that is none of the known ones."""
    for (road,), (brakes, accident, ahead) in zip(cases, answers, strict=True):
        if brakes:
            return f"Your plan brakes for {brakes:.0f} s. Find one that only keeps its speed or accelerates."
        if accident:
            kind = Accident(int(accident)).name.lower().replace("_", " ")
            return f"On road {road} your plan ends in an accident in the first {EARLY} s: {kind}."
        if not ahead:
            return f"On road {road} your plan does not end ahead of trap 1."
    return "Your plan drives differently from call to call."
