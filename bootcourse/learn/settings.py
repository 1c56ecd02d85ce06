"""The settings that all methods share, with their sources. A method with settings of its own adds them in its file.

† printed in the paper (Table "RL hyper-parameters", Section IV); ‡ inferred from the paper, with the reason; § our
choice.
"""

from dataclasses import dataclass, fields, replace
from functools import partial

import numpy as np

from bootcourse.errors import BootcourseError, check_known, require, whole
from bootcourse.limits import check_limits, limited
from bootcourse.methods import METHODS
from bootcourse.scenario import check_p

MAX_SEED = 8_000_000  # the roads of a larger training seed would be those of the demonstrations (see training.py)
shared = partial(limited, shared=True)  # a field that must be equal for all agents that train side by side


@dataclass(frozen=True)
class Settings:
    """One agent's settings. The defaults are the paper's method; use `settings_for` for other methods.

    Raises BootcourseError for a value that is out of range or contradicts the method.
    """

    method: str = "bootstrapped"
    seed: int = limited(0, low=0, high=MAX_SEED)
    gamma: float = limited(0.8, low=0, high=1)  # † discount factor γ
    target_entropy: float = -1.0  # nats † η; a categorical policy's entropy is never negative
    alpha_init: float = limited(0.01, above=0)  # † initial entropy coefficient α
    xi_multiplier: float = limited(200.0, low=0)  # † ξ = 200 α; 0 switches the soft constraint off
    xi_fixed: float | None = limited(None, low=0)  # § a constant ξ; None: ξ follows α
    xi_min: float = limited(0.0, low=0)  # § the least ξ: where 200 α has fallen below it, ξ stays there
    kl_in_target: bool = True  # ‡ the paper's KL is part of the return, so it is in the critic's target too
    rule_p: float = 0.9  # † p of the stochastic rule π̃
    beta_start: float = limited(0.6, low=0, high=1)  # † initial share of demonstrations in a batch; 0: none
    beta_episodes: int | None = limited(1000, low=1)  # † episodes until that share is 0; None: it stays
    bonus: float = 2.0  # † c, added to a demonstration's reward
    margin: float = limited(0.0, low=0)  # weight of the large-margin loss; 0 switches it off
    paper_q_filter: bool = True  # † the printed Q-filter; False: the usual one
    cql_weight: float = limited(0.0, low=0)  # § weight of CQL's conservative term; 0 switches it off
    # The same for all agents that train side by side:
    hidden: tuple = shared((64, 64))  # § neurons in each hidden layer
    actor_lr: float = shared(5e-4, low=0)  # † α_a
    critic_lr: float = shared(1e-3, low=0)  # † α_c
    alpha_lr: float = shared(1e-3, low=0)  # †
    batch: int = shared(64, low=1)  # † N
    buffer_size: int = shared(50_000)  # † D, transitions
    tau: float = shared(0.005, low=0, high=1)  # § the target critics' step towards the critics (Polyak averaging)
    envs_per_agent: int = shared(4, low=1)  # § roads that each agent drives at the same time
    updates: int = shared(1, low=1)  # § updates after each decision on these roads
    learning_starts: int = shared(256, low=0)  # § decisions before the first update
    demonstration_episodes: int = shared(200, low=1)  # † episodes
    stochastic_demonstrations: bool = shared(False)  # ‡ of π̃, as printed, some would fail (demonstrations.py)

    def __post_init__(self):
        for name, value in vars(self).items():
            if isinstance(value, np.generic):  # a number of NumPy's
                object.__setattr__(self, name, value.item())
        check_known("Method", self.method, METHODS)
        check_limits(self)
        check_p(self.rule_p, "rule_p")
        whole(self.buffer_size, "buffer_size", low=max(self.batch, self.envs_per_agent))
        sizes = self.hidden if isinstance(self.hidden, (tuple, list)) else ()
        if not sizes or any(not isinstance(size, int) or size < 1 for size in sizes):
            raise BootcourseError(f"hidden = {self.hidden!r}: give the layers' sizes, such as (64, 64).")
        object.__setattr__(self, "hidden", tuple(sizes))
        self._check_label()

    def _check_label(self) -> None:
        """Check that no ingredient is switched on that the method is defined by leaving out."""
        lacks = {name for name, value in METHODS[self.method].settings.items() if value == 0}
        lacks |= {"xi_fixed", "xi_min"} if "xi_multiplier" in lacks else set()
        for name in sorted(lacks):
            value, without = getattr(self, name), f"method '{self.method}' is defined by doing without"
            remedy = f"write settings_for('{self.method}'), or choose a method that has it"
            require(not value or value < 0, f"{name} = {value!r}, but {without}: {remedy}.")

    @property
    def needs_demonstrations(self) -> bool:
        """Whether the agent's batches contain demonstrations."""
        return self.beta_start > 0

    @property
    def asks_teacher(self) -> bool:
        """Whether the agent uses the teacher's actions in the states that it reaches itself, or in its batches."""
        xi = max(self.xi_min, self.xi_multiplier if self.xi_fixed is None else self.xi_fixed)
        return xi > 0 or METHODS[self.method].taught


def settings_class(method: str) -> type[Settings]:
    """The class of a method's settings; `Settings`, which refuses it, for an unknown method."""
    return METHODS[method].settings_class() if method in METHODS else Settings


def shared_fields(kind: type[Settings]) -> tuple[str, ...]:
    """The settings that must be equal for all agents that train side by side."""
    return tuple(f.name for f in fields(kind) if f.metadata.get("shared"))


# Named settings. The defaults are quick: a quarter of an update for each decision. Those of "paper" make eight times as
# many updates, on one road per agent. The paper prints neither number. With these the order of its Table 4 comes out:
# of ten agents each, 0 (SAC), 5 (soft), 10 (demos) and 10 (bootstrapped) escape (`bootcourse study clocks`).
SETTINGS = {
    "quick": {},
    "paper": {"envs_per_agent": 1, "updates": 2, "stochastic_demonstrations": True},  # §
}


def settings_for(method: str, setting: str = "quick", **changes) -> Settings:
    """The settings of a method, with changes: settings_for("sac", gamma=0.9).

    setting: a name of `SETTINGS`, "quick" or "paper". Raises BootcourseError for an unknown name or an invalid value.
    """
    check_known("Method", method, METHODS)
    check_known("Setting", setting, SETTINGS)
    kind = settings_class(method)
    if setting != "quick" and METHODS[method].on_policy:
        raise BootcourseError(f"Method '{method}' has no setting '{setting}': leave it out.")
    known = [f.name for f in fields(kind)]
    for name in changes:
        check_known(f"Setting of '{method}'", name, known)
    return kind(method=method, **(METHODS[method].settings | SETTINGS[setting] | changes))


def stored_settings(stored: dict) -> Settings:
    """The settings in a file {name: value}. Raises BootcourseError for an invalid value or an unknown name."""
    kind = settings_class(stored.get("method", ""))
    if unknown := sorted(stored.keys() - {f.name for f in fields(kind)}):
        raise BootcourseError(f"Settings have no {', '.join(unknown):.80}: another version wrote them.")
    return kind(**stored)


def with_seeds(settings: Settings, seeds: int, first: int = 0) -> list[Settings]:
    """The same settings with the seeds first, first + 1, ...: one for each agent of a `Training`."""
    first, seeds = whole(first, "first seed", MAX_SEED), whole(seeds, "seeds", MAX_SEED)
    return [replace(settings, seed=seed) for seed in range(first, first + seeds)]
