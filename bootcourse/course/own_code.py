"""A student's own code trains the agent: an answer that passed its check replaces the library's part.

    own_code.load()                          # the parts that passed in earlier lessons, from answers/NAME.py
    training = own_code.training(settings)   # a `Training`; one line says whose parts it is made of
    own_code.compare()                       # do your parts make the same update as ours?
    own_code.use(critic_target)              # without a check: what does an agent learn with a mistake?

An answer that passes its check in a notebook is kept in the folder `answers/` beside the notebooks. `load` alone runs
these files, and only a cell of a notebook calls it. `own_learner.py` puts the parts together.
"""

import functools
from collections.abc import Callable, Sequence

import torch

from bootcourse.course import answer_files
from bootcourse.course.answer_files import PARTS
from bootcourse.course.judge import judge
from bootcourse.course.lessons import registry
from bootcourse.course.own_learner import ALONE, BUFFER, own_learner, part, parts_of
from bootcourse.course.verdict import Verdict
from bootcourse.errors import BootcourseError, check_known
from bootcourse.learn.learner import SACLearner, learner_for
from bootcourse.learn.replay_buffer import Batch
from bootcourse.learn.settings import Settings, settings_for
from bootcourse.learn.training import Training

APART = {name for names in ALONE.values() for name in names}  # parts of other learners than SAC
APART |= {"advantages", "clipped_loss", "ppo_loss", "rollout_values", "shield", "update", "train"}
NONE = "No part is yours yet: agents train with the library's own."
TOLERANCE = 1e-3  # relative difference of a loss or a gradient; rounding gives about 1e-6
_own: dict[str, Callable] = {}  # the student's parts in this kernel


def use(answer: Callable) -> None:
    """Train with this function or class from now on, in this notebook. Raises BootcourseError if it is no part."""
    name = getattr(answer, "__name__", repr(answer))
    check_known("The part", name, PARTS)
    _own[name] = answer


def keep(name: str, answer: Callable) -> str:
    """An answer has passed its check: use it, and keep it for later lessons. Returns a sentence, "" for no part.

    Only what a notebook defines is a student's: a function of the library is not kept.
    """
    if name not in PARTS or answer.__module__ != "__main__" or getattr(answer, "__name__", "") != name:
        return ""
    use(answer)
    try:
        return f"From here on, agents train with your `{name}`. It is kept in {answer_files.write(name, answer)}."
    except BootcourseError as error:
        return f"From here on, agents train with your `{name}`, in this notebook alone: {error}"


def load() -> None:
    """Run the parts' files in `answers/`, use them, print which. Raises BootcourseError if one does not run."""
    found = [name for name in PARTS if (answer_files.FOLDER / f"{name}.py").is_file()]
    for name in found:
        _own[name] = answer_files.read(name)
    print(f"Found in {answer_files.FOLDER}: {whose(found)}.".replace("`", "") if found else NONE)


def whose(names: Sequence[str]) -> str:
    """your `critic_target`, our `actor_loss`"""
    return ", ".join(f"{'your' if name in _own else 'our'} `{name}`" for name in names)


def training(settings: Sequence[Settings], episodes: int = 1000, **more) -> Training:
    """A `Training` of these settings with the student's parts; prints whose they are. more: as for `Training`.

    Raises BootcourseError for parts of the student on another device than the CPU.
    """
    names = parts_of(settings, _own) if settings else []
    own = {name: _own[name] for name in names if name in _own}
    if own and more.get("device", "cpu") != "cpu":
        raise BootcourseError(f"Your own code trains on the CPU: leave out device={more['device']!r}.")
    make_learner = functools.partial(own_learner, own) if own else learner_for
    mine = Training(settings, episodes, make_learner=make_learner, **more)
    print(f"Training with {whose(names) or 'no part that an exercise writes'}.".replace("`", ""))
    return mine


def yours_or_ours(name: str, doing: str = "Training") -> Callable:
    """The student's part, or the exercise's solution, for what is no learner's; prints what is done with whose."""
    print(f"{doing} with {whose([name])}.".replace("`", ""))
    return part(_own, name)


# Do they make the same update? -----------------------------------------------------------------------

LOSSES = {
    "critic_loss": "the critics' loss",
    "actor_loss": "the actor's loss",
    "temperature_loss": "the temperature's loss",
}


def compare() -> Verdict:
    """Whether each of the student's parts makes the same update as the library's, on one batch; if not, which differs.

    Losses and gradients are compared. The buffer's parts, which draw at random, and those of `APART` go through
    their checks again.
    """
    mine = [name for name in PARTS if name in _own]
    if not mine:
        return Verdict("todo", NONE)
    found = {name: difference(name) for name in mine}
    wrong = {name: words for name, words in found.items() if words}
    if not wrong:
        return Verdict("passed", f"Your learner makes the same update as ours. Compared: {whose(mine)}.")
    return Verdict("wrong", f"Something is wrong with {whose(list(wrong))}.", tuple(wrong.values()))


def difference(name: str) -> str:
    """What differs if this one part is the student's and all others are ours; "" if nothing does."""
    if name in (*BUFFER, *APART):
        verdict = judge(registry()[name], _own[name])
        return "" if verdict.passed else f"{name}: {verdict.sentence}"
    try:
        ours, theirs = update({}), update({name: _own[name]})
    except Exception as error:  # whatever the student's function raises
        return f"{name} raises {type(error).__name__}: {' '.join(str(error).split())}"
    for what, right in ours.items():
        far = float((theirs[what] - right).abs().max() / right.abs().max())
        if not far <= TOLERANCE:  # also where it is NaN
            return f"{name}: {what} differs from ours by {100 * far:.2g} %."
    return ""


def update(own: dict[str, Callable]) -> dict[str, torch.Tensor]:
    """The losses and gradients of a learner with these parts on one batch: {what it is: its numbers}."""
    changes = {"hidden": (16,), "alpha_init": 0.5, "margin": 1.0}  # every term of the losses counts
    agents = [
        settings_for("bootstrapped", xi_multiplier=1.0, **changes),
        settings_for("bootstrapped", seed=1, xi_multiplier=0.4, gamma=0.95, rule_p=0.7, target_entropy=0.6, **changes),
    ]
    made = own_learner(own, agents, 26, 9) if own else SACLearner(agents, 26, 9)
    terms = made.losses(batch_with_everything(len(agents)))
    sum(terms[name] for name in LOSSES).sum().backward()
    found = {words: terms[name].detach() for name, words in LOSSES.items()}
    for owner, parameters in (("actor's", made.actor), ("critics'", made.critics), ("temperature's", [made.log_alpha])):
        slopes = [torch.zeros_like(each) if each.grad is None else each.grad for each in parameters]
        found[f"the {owner} gradient"] = torch.cat([slope.flatten() for slope in slopes])
    return found


def batch_with_everything(agents: int, size: int = 64) -> Batch:
    """A random batch in which episodes end, and half of the rows are demonstrations."""
    draw = torch.Generator().manual_seed(0)
    states, next_states = torch.randn(2, agents, size, 26, generator=draw)
    actions, rule_actions, next_rule_actions = torch.randint(0, 9, (3, agents, size), generator=draw)
    ends = (torch.arange(size) % 4 == 0).float().expand(agents, -1)
    rewards, theirs = torch.randn(agents, size, generator=draw), (torch.arange(size) < size // 2).float()
    return Batch(
        states, next_states, actions, rewards, ends, rule_actions, next_rule_actions, theirs.expand(agents, -1)
    )
