"""A rollout: the recording of one episode, which figures, panels and replays show."""

import json
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from bootcourse.errors import BootcourseError
from bootcourse.files import read_arrays, write_arrays
from bootcourse.road.state import COLUMNS, EGO, HEADING, SPEED, TRAP_1, Accident, X, Y
from bootcourse.scenario import N_ACTIONS, RULE_P, Scenario, check_p

FORMAT = "bootcourse rollout 1"
REQUIRED = ("states", "observations", "actions", "rewards", "terms")
OPTIONAL = ("policy", "q_values", "rule_actions", "rule_speeds", "rule_lanes", "rule_distances", "rule_reasons")


@dataclass(frozen=True)
class Rollout:
    """T decisions of one drive, S simulation steps (T x steps per decision; fewer after an accident).

    The optional arrays are None if the driver does not provide them (the idle policy has no Q).
    Raises BootcourseError if the arrays' shapes do not fit together or a number is not finite.
    """

    scenario: Scenario
    label: str  # the driver, e.g. "rule", "sac", "bootstrapped"
    seed: int  # the road's
    states: np.ndarray  # (S + 1, vehicles, 10) float64, columns of bootcourse.road.state; [0] is the start
    observations: np.ndarray  # (T + 1, observation_size) float32
    actions: np.ndarray  # (T,) int, 0..8
    rewards: np.ndarray  # (T,) float
    terms: np.ndarray  # (T, 3) float: r_v, r_y, r_θ, unweighted
    accident: int  # the number of an `Accident`
    policy: np.ndarray | None = None  # (T, 9) the driver's probabilities π(a|s)
    q_values: np.ndarray | None = None  # (T, 9) the smaller of the driver's two Q(s, a)
    rule_actions: np.ndarray | None = None  # (T,) int, the rule's action
    rule_speeds: np.ndarray | None = None  # (T,) m/s, the rule's target speed
    rule_lanes: np.ndarray | None = None  # (T,) int, the rule's target lane
    rule_distances: np.ndarray | None = None  # (T,) m, the rule's safety distance
    rule_reasons: np.ndarray | None = None  # (T,) int, the number of a `bootcourse.rule.Reason`
    rule_p: float = RULE_P  # p of the stochastic rule in this drive's KL (Equation 15)
    provenance: dict = field(default_factory=dict)  # versions, see `bootcourse.files.provenance`

    def __post_init__(self):
        check_p(self.rule_p, "rule_p")
        whole = ("actions", "rule_actions", "rule_lanes", "rule_reasons")
        for name in (*REQUIRED, *OPTIONAL):
            array = getattr(self, name)
            if array is None and name in OPTIONAL:
                continue
            kinds = "iu" if name in whole else "iuf"
            _check(
                isinstance(array, np.ndarray) and array.ndim > 0 and array.dtype.kind in kinds,
                f"This rollout's {name} are not {'whole ' * (name in whole)}numbers in a row: record it again.",
            )
        steps, decisions = len(self.states) - 1, len(self.actions)
        _check(decisions > 0, "This rollout has no decisions: record it again.")
        shapes = {
            "states": (steps + 1, self.scenario.vehicles, COLUMNS),
            "observations": (decisions + 1, self.scenario.observation_size),
            "terms": (decisions, 3),
            "policy": (decisions, N_ACTIONS),
            "q_values": (decisions, N_ACTIONS),
        }
        for name in (*REQUIRED, *OPTIONAL):
            array, shape = getattr(self, name), shapes.get(name, (decisions,))
            if array is None:
                continue
            _check(
                array.shape == shape, f"This rollout's {name} have shape {array.shape}, not {shape}: record it again."
            )
            _check(bool(np.isfinite(array).all()), f"This rollout's {name} hold NaN or infinity: record it again.")
        per_decision = self.scenario.clock.steps
        _check(
            (decisions - 1) * per_decision < steps <= decisions * per_decision,
            f"This rollout has {steps} simulation steps for {decisions} decisions: record it again.",
        )
        _check(
            bool(((self.actions >= 0) & (self.actions < N_ACTIONS)).all()), "This rollout has an action outside 0..8."
        )
        _check(self.accident in set(Accident), f"This rollout's accident {self.accident} is unknown.")

    @property
    def times(self) -> np.ndarray:
        """The time of each state in seconds, (S + 1,)."""
        return np.arange(len(self.states)) * self.scenario.clock.dt

    @property
    def success(self) -> bool:
        """Whether the ego is ahead of trap 1 at the end, also if the episode ended in an accident."""
        return bool(self.states[-1, EGO, X] > self.states[-1, TRAP_1, X])

    @property
    def distance(self) -> float:
        """The distance that the ego drove, in metres."""
        return float(self.states[-1, EGO, X] - self.states[0, EGO, X])

    def save(self, path: Path) -> Path:
        """Write to `path` (.npz) and return it. Raises BootcourseError if the file cannot be written."""
        header = {
            "format": FORMAT,
            "scenario": json.loads(self.scenario.to_json()),
            "label": self.label,
            "seed": int(self.seed),
            "accident": int(self.accident),
            "rule_p": self.rule_p,
            "provenance": self.provenance,
        }
        names = (*REQUIRED, *OPTIONAL)
        arrays = {name: getattr(self, name) for name in names if getattr(self, name) is not None}
        write_arrays(path, {**arrays, "header": np.array(json.dumps(header))})
        return Path(path)

    @classmethod
    def load(cls, path: Path) -> "Rollout":
        """Read and check a rollout. Raises BootcourseError, with the file and the remedy, if it is damaged."""
        arrays = read_arrays(path)
        try:
            header = json.loads(str(arrays.pop("header")))
            written = header["format"]
        except (KeyError, TypeError, ValueError):
            raise BootcourseError(f"{path} is not a rollout: record one with `bootcourse drive`.") from None
        if written != FORMAT:
            raise BootcourseError(f"{path} has the format '{written}', this version reads '{FORMAT}': record it again.")
        try:
            return cls(
                scenario=Scenario.from_json(json.dumps(header["scenario"])),
                label=header["label"],
                seed=header["seed"],
                accident=header["accident"],
                rule_p=header.get("rule_p", RULE_P),  # absent in files of earlier versions
                provenance=header["provenance"],
                **arrays,
            )
        except (KeyError, TypeError) as error:
            raise BootcourseError(f"{path} is incomplete ({error}): record it again.") from None
        except BootcourseError as error:
            raise BootcourseError(f"{path}: {error}") from None


def series(rollout: Rollout, what: str) -> tuple[np.ndarray, np.ndarray]:
    """A drive over time: (seconds, values), both (n,).

    what: "speed" (m/s), "distance" (m ahead of trap 1), "lane" (a real number), "reward" or "return" (so far).
    """
    ego, trap = rollout.states[:, EGO], rollout.states[:, TRAP_1]
    decided = (np.arange(len(rollout.actions)) + 1.0) / rollout.scenario.clock.decision_rate
    decided[-1] = rollout.times[-1]
    if what == "reward":
        return np.r_[0.0, decided], np.r_[rollout.rewards[:1], rollout.rewards]
    if what == "return":
        return np.r_[0.0, decided], np.r_[0.0, np.cumsum(rollout.rewards)]
    values = {
        "speed": ego[:, SPEED],
        "distance": ego[:, X] - trap[:, X],
        "lane": ego[:, Y] / rollout.scenario.road.lane_width,
    }
    return rollout.times, values[what]


def interpolate_states(states, step: float) -> np.ndarray:
    """The state (vehicles, 10) at a fractional simulation step, by linear interpolation; clamped to the ends.

    states: (S + 1, vehicles, 10), or a list of (vehicles, 10).
    """
    step = min(max(step, 0.0), len(states) - 1)
    before = int(step)
    after = min(before + 1, len(states) - 1)
    here = np.asarray(states[before])
    moved = here + (step - before) * (np.asarray(states[after]) - here)
    turn = states[after][:, HEADING] - here[:, HEADING]
    moved[:, HEADING] = here[:, HEADING] + (step - before) * ((turn + np.pi) % (2 * np.pi) - np.pi)
    return moved


def _check(holds: bool, sentence: str) -> None:
    if not holds:
        raise BootcourseError(sentence)
