"""A student's own code trains the agent: an answer that passed its check replaces the library's part.

    own_code.load()                          # the parts that passed in earlier lessons, from answers/NAME.py
    training = own_code.training(settings)   # a `Training`; one line says whose parts it is made of
    own_code.compare()                       # do your parts make the same update as ours?
    own_code.use(critic_target)              # without a check: what does an agent learn with a mistake?

An answer that passes its check in a notebook is kept in the folder `answers/` beside the notebooks. `load` alone runs
these files, and only a cell of a notebook calls it. `own_learner.py` puts the parts together.
"""

import functools
import textwrap
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import torch

from bootcourse.course import answer_files
from bootcourse.course.answer_files import PARTS
from bootcourse.course.judge import judge
from bootcourse.course.lessons import registry
from bootcourse.course.notebook import beside_the_notebook
from bootcourse.course.own_learner import own_learner, part, parts_of
from bootcourse.course.verdict import Verdict
from bootcourse.errors import BootcourseError, check_known
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.networks import mlp
from bootcourse.learn.replay_buffer import Batch
from bootcourse.learn.settings import Settings, settings_for
from bootcourse.learn.training import Training

COMPARED = ("soft_value", "critic_target", "critic_loss", "actor_loss", "temperature_loss", "soft_constraint",
            "constrained_loss", "constrained_target")  # parts of SAC's update  # fmt: skip
NONE = "No part is yours yet: agents train with the library's own."
TOLERANCE = 1e-3  # relative difference of a loss or a gradient; rounding gives about 1e-6
_own: dict[str, Callable] = {}  # the student's parts in this kernel


def use(answer: Callable) -> None:
    """Train with this function or class from now on, in this notebook. Raises BootcourseError if it is no part."""
    name = getattr(answer, "__name__", repr(answer))
    check_known("The part", name, PARTS)
    _own[name] = answer


def keep(name: str, answer: Callable) -> str:
    """An answer has passed its check: later cells use it, see `yours_or_ours`. Returns a sentence, "" for no part.

    A part is also kept for later lessons. Only what a notebook defines is a student's: a function of the library is
    not kept.
    """
    if answer.__module__ != "__main__" or getattr(answer, "__name__", "") != name:
        return ""
    _own[name] = answer
    if name not in PARTS:
        return ""
    try:
        return f"From here on, the lessons use your `{name}`. It is kept in {answer_files.write(name, answer)}."
    except BootcourseError as error:
        return f"From here on, lessons use your `{name}`, in this notebook alone: {error}"


def load() -> None:
    """Run the parts' files in `answers/`, use them, print which. Raises BootcourseError if one does not run."""
    stored = [name for name in PARTS if answer_files.file_of(name).is_file()]
    for name in stored:
        _own[name] = answer_files.read(name)
    folder = beside_the_notebook() / answer_files.FOLDER
    say(f"Found in {folder}: {whose(stored)}." if stored else NONE)


def say(sentence: str) -> None:
    """Print a sentence in lines that a notebook's column holds: JupyterLab would break them inside a word."""
    print(textwrap.fill(sentence.replace("`", ""), 80, break_long_words=False, break_on_hyphens=False))


def whose(names: Sequence[str]) -> str:
    """your `critic_target`, our `actor_loss`"""
    return ", ".join(f"{'your' if name in _own else 'our'} `{name}`" for name in names)


def training(settings: Sequence[Settings], episodes: int = 1000, **more) -> Training:
    """A `Training` of these settings with the student's parts; prints whose they are. more: as for `Training`.

    As long as no part is the student's, the library's compiled learner trains, if it has these settings.
    Raises BootcourseError for parts of the student on another device than the CPU.
    """
    names = parts_of(settings, _own) if settings else []
    own = {name: _own[name] for name in names if name in _own}
    if own and more.get("device", "cpu") != "cpu":
        raise BootcourseError(f"Your own code trains on the CPU: leave out device={more['device']!r}.")
    if own:
        more["make_learner"] = functools.partial(own_learner, own)
    else:
        more.setdefault("learner", "faster")
    mine = Training(settings, episodes, **more)
    say(f"Training with {whose(names) or 'no part that an exercise writes'}.")
    return mine


def yours_or_ours(*names: str, doing: str = "Training") -> Any:
    """The student's answer to an exercise if it passed its check, else the solution; of several exercises a list.

    Prints what is done with whose: "Training with your `update`, our `train`."
    """
    say(f"{doing} with {whose(names)}.")
    answers = [part(_own, name) for name in names]
    return answers[0] if len(names) == 1 else answers


# Do they make the same update? -----------------------------------------------------------------------

LOSSES = {
    "critic_loss": "the critics' loss",
    "actor_loss": "the actor's loss",
    "temperature_loss": "the temperature's loss",
}


class Magnitude(NamedTuple):
    """How large the numbers of an update are. Each of `MAGNITUDES` occurs in a training."""

    words: str
    alpha: float  # the temperature
    value: float = 1.0  # the width of the rewards, and of Q's spread over the actions
    shift: float = 0.0  # all Q are about this large
    logit: float = 1.0  # the width of the policy's logits: log π falls to minus a few of these
    rule_p: float = 0.9  # the KL is log (8 / (1 - p)) nats where the policy is sure of another action than the rule's


MAGNITUDES = (
    Magnitude("at the start", 0.5),
    Magnitude("with Q near -43, as after accidents", 0.01, value=10.0, shift=-43.0),
    Magnitude("with Q near 200 and errors of 30", 0.002, value=30.0, shift=200.0),
    Magnitude("with a nearly sure policy, log π to -120 and a KL of 9 nats", 0.5, logit=40.0, rule_p=0.999),
    Magnitude("with α = 0.00001", 1e-5),
    Magnitude("with α = 10", 10.0, value=3.0),
)


def compare() -> Verdict:
    """Whether each of the student's parts makes the same update as the library's; if not, which one differs.

    Losses and gradients are compared, on a batch of each of the `MAGNITUDES`. Parts that are not `COMPARED`, because
    they draw at random or belong to another learner, go through their checks again.
    """
    mine = [name for name in PARTS if name in _own]
    if not mine:
        return Verdict("todo", NONE)
    differences = {name: difference(name) for name in mine}
    wrong = {name: words for name, words in differences.items() if words}
    if not wrong:
        return Verdict("passed", f"Your learner makes the same update as ours. Compared: {whose(mine)}.")
    return Verdict("wrong", f"Something is wrong with {whose(list(wrong))}.", tuple(wrong.values()))


def difference(name: str) -> str:
    """What differs if this one part is the student's and all others are ours; "" if nothing does."""
    if name not in COMPARED:
        verdict = judge(registry()[name], _own[name])
        return "" if verdict.is_right else f"{name}: {verdict.sentence}"
    for magnitude in MAGNITUDES:
        try:
            ours, theirs = our_update(magnitude), update({name: _own[name]}, magnitude)
        except Exception as error:  # whatever the student's function raises
            return f"{name} raises {type(error).__name__}: {' '.join(str(error).split())}"
        for what, right in ours.items():
            far = float((theirs[what] - right).abs().max() / right.abs().max())
            if not far <= TOLERANCE:  # also where it is NaN
                return f"{name}: {what} differs from ours by {100 * far:.2g} % {magnitude.words}."
    return ""


@functools.cache
def our_update(magnitude: Magnitude) -> dict[str, torch.Tensor]:
    return update({}, magnitude)


def update(own: dict[str, Callable], magnitude: Magnitude) -> dict[str, torch.Tensor]:
    """The losses and gradients of a learner with these parts on one batch: {what it is: its numbers}."""
    changes = {"hidden": (16,), "alpha_init": magnitude.alpha, "rule_p": magnitude.rule_p}
    changes |= {"margin": 10 * magnitude.value}  # every term of the losses counts
    agents = [
        settings_for("bootstrapped", xi_multiplier=1.0, **changes),
        settings_for("bootstrapped", seed=1, xi_multiplier=0.4, gamma=0.95, target_entropy=0.6, **changes),
    ]
    learner = own_learner(own, agents, 26, 9) if own else SACLearner(agents, 26, 9)
    enlarge(learner, magnitude)
    batch = batch_with_everything(len(agents))
    terms = learner.losses(batch._replace(rewards=magnitude.value * batch.rewards))
    sum(terms[name] for name in LOSSES).sum().backward()
    numbers = {words: terms[name].detach() for name, words in LOSSES.items()}
    tensors = {"actor's": learner.actor, "critics'": learner.critics, "temperature's": [learner.log_alpha]}
    for owner, parameters in tensors.items():
        slopes = [torch.zeros_like(each) if each.grad is None else each.grad for each in parameters]
        numbers[f"the {owner} gradient"] = torch.cat([slope.flatten() for slope in slopes])
    return numbers


@torch.no_grad()
def enlarge(learner: SACLearner, magnitude: Magnitude) -> None:
    """Give a new learner's policy logits, and its critics and their copies values, of this magnitude."""
    states = batch_with_everything(learner.agents).states
    for network, width, shift in (
        (learner.actor, magnitude.logit, 0.0),
        (learner.critics, magnitude.value, magnitude.shift),
        (learner.target_critics, magnitude.value, magnitude.shift),
    ):
        *_, weights, biases = network  # of the last layer
        outputs = mlp(network, states.repeat(len(weights) // learner.agents, 1, 1))  # (networks, batch, 9)
        factor = width / outputs.std()
        weights *= factor
        biases *= factor
        biases += shift


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
