"""Who can drive in a world, besides those that the page brings: agents, policies, rules, plans and recorded drives.

An agent's weights go to the page and drive there; a plan's actions too. A policy or a rule stays in Python and is asked
for each decision.
"""

import inspect
from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

from bootcourse.colours import STRANGERS
from bootcourse.errors import BootcourseError, check_known, whole
from bootcourse.methods import display_name, has_style, style
from bootcourse.scenario import DEFAULT, N_ACTIONS, Scenario

# Drivers of the page, as drivers.js calls them, and the labels of their drives.
KNOWN = {"you": "you", "rule": "rule", "sac": "sac", "escaping": "bootstrapped", "crashing": "bootstrapped",
         "ppo": "ppo_cloned", "lookahead": "lookahead", "soft": "soft"}  # fmt: skip
COLOURS = [STRANGERS[i].colour for i in (2, 1, 3)]  # of other guests, the one least like the rule's green first


class Guest(NamedTuple):
    """A driver of a world."""

    label: str  # of its drives, such as "sac, seed 3"
    told: dict | None = None  # what the page is told (see `guest` in drivers.js); None for one that it has already
    decide: Callable | None = None  # for one that stays in Python: a policy


def guest(who, number: int, name: str = "", scenario: Scenario = DEFAULT) -> Guest:
    """Make a driver of a world out of anything that drives.

    number: of this guest, for its id. name: in lists and pictures; by default its own.
    Raises BootcourseError for what cannot drive.
    """
    if who is None or isinstance(who, str):
        return _by_name(who or "you", number)
    if hasattr(who, "as_policy"):
        label = name or f"{who.settings.method}, seed {who.settings.seed}"
        if not alone(who):
            return Guest(label, _told(label, number), who.as_policy())
        from bootcourse.web.packing import EXACT, packed_network

        return Guest(label, _told(label, number) | {"network": packed_network(who.actor, 0, EXACT)})
    actions = getattr(who, "actions", who)  # of a Rollout or a PlanPolicy
    if not callable(actions):
        label = name or getattr(who, "label", "plan")
        return Guest(label, _told(label, number) | {"plan": _plan(actions)})
    label = name or _called(who)
    return Guest(label, _told(label, number), _policy(who, scenario))


def _by_name(name: str, number: int) -> Guest:
    if name == "idle":
        return Guest("idle", _told("idle", number) | {"plan": []})
    check_known("The driver", name, [*KNOWN, "idle"])
    return Guest(KNOWN[name])


def _told(label: str, number: int) -> dict:
    name = display_name(label)
    colour = style(label).colour if has_style(label) else COLOURS[number % len(COLOURS)]
    return {"id": f"guest{number}", "name": name, "label": name, "colour": colour, "words": ""}


def alone(agent) -> bool:
    """Whether the actor alone says what an agent does: the page has no critics or teachers of others."""
    from bootcourse.learn.protocol import Learner

    return agent.kind.driving_policy.__func__ is Learner.driving_policy.__func__


def _plan(actions: Sequence) -> list[int]:
    """Actions 0..8, or a plan in words as `plan_policy` takes it, as numbers."""
    try:
        entries = list(actions)
    except TypeError:
        raise BootcourseError(f"{actions!r:.80} cannot drive: give an agent, a policy, a rule or a plan.") from None
    if entries and isinstance(entries[0], (str, tuple)):
        from bootcourse.policies import plan_policy

        entries = plan_policy(entries).actions
    return [whole(action, "action", N_ACTIONS - 1) for action in entries]


def _called(function) -> str:
    """Its name, or that of the function of which it is a part; the library's own have none that a reader knows."""
    while isinstance(function, partial):
        function = function.func
    own = getattr(function, "__name__", type(function).__name__)
    return "idle" if own == "idle_policy" else "policy" if own.startswith(("_", "<")) or own == "drive" else own


def _policy(function, scenario: Scenario):
    """A policy as it is, a rule of (cars, scenario) as a policy."""
    try:
        is_rule = next(iter(inspect.signature(function).parameters), "") == "cars"
    except (TypeError, ValueError):
        is_rule = False
    from bootcourse.learn.teachers import teacher_policy
    from bootcourse.policies import check_policy

    return teacher_policy(function, scenario) if is_rule else check_policy(function)
