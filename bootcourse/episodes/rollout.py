"""A rollout: the recording of one episode, which figures, panels and replays show."""

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Annotated, Any, ClassVar

import msgspec
import numpy as np

from bootcourse.errors import BootcourseError, require, whole
from bootcourse.files import decoding, parse, read_arrays, write_arrays
from bootcourse.road.state import COLUMNS, EGO, HEADING, SPEED, TRAP_1, Accident, X, Y
from bootcourse.rule import Reason
from bootcourse.scenario import N_ACTIONS, RULE_P, Scenario, check_p

LONGEST_LABEL = 100  # characters
LARGEST = 1e9  # of any number of a drive, either sign; a road is some kilometres long
RECORD_AGAIN = "record it again, or restore it from a copy"
BY_RULE = ("rule_actions", "rule_speeds", "rule_lanes", "rule_distances", "rule_reasons")
REQUIRED = ("states", "observations", "actions", "rewards", "terms", *BY_RULE)
HIGHEST = {"actions": N_ACTIONS - 1, "rule_actions": N_ACTIONS - 1, "rule_lanes": 7, "rule_reasons": max(Reason)}
OPTIONAL = ("policy", "q_values")


class Header(msgspec.Struct, forbid_unknown_fields=True):
    """What a rollout's file holds beside its arrays."""

    FORMAT: ClassVar[str] = "bootcourse rollout 1"
    format: str
    scenario: Scenario
    label: Annotated[str, msgspec.Meta(max_length=LONGEST_LABEL)]
    seed: Annotated[int, msgspec.Meta(ge=0, le=2**63 - 1)]
    accident: Accident
    provenance: dict[str, Any]
    rule_p: float  # checked by `Rollout`


@dataclass(frozen=True)
class Rollout:
    """T decisions of one drive, S simulation steps (T x steps per decision; fewer after an accident).

    π and Q are None if the driver does not provide them (the idle policy has neither).
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
    rule_actions: np.ndarray  # (T,) int, the rule's action
    rule_speeds: np.ndarray  # (T,) m/s, the rule's target speed
    rule_lanes: np.ndarray  # (T,) int, the rule's target lane
    rule_distances: np.ndarray  # (T,) m, the rule's safety distance
    rule_reasons: np.ndarray  # (T,) int, the number of a `bootcourse.rule.Reason`
    policy: np.ndarray | None = None  # (T, 9) the driver's probabilities π(a|s)
    q_values: np.ndarray | None = None  # (T, 9) the smaller of the driver's two Q(s, a)
    rule_p: float = RULE_P  # p of the stochastic rule in this drive's KL (Equation 15)
    provenance: dict = field(default_factory=dict)  # versions, see `bootcourse.files.provenance`

    def __post_init__(self):
        check_p(self.rule_p, "rule_p")
        require(len(self.label) <= LONGEST_LABEL, f"label = {self.label:.80}: give at most {LONGEST_LABEL} characters.")
        whole(self.seed, "seed")
        require(self.accident in set(Accident), f"This rollout's accident {self.accident!r:.80} is unknown.")
        for name in (*REQUIRED, *OPTIONAL):
            if name in REQUIRED or getattr(self, name) is not None:
                _check_array(name, getattr(self, name))
        steps, decisions, per_decision = len(self.states) - 1, len(self.actions), self.scenario.clock.steps
        require(decisions > 0, "This rollout has no decisions: record it again.")
        shapes = {
            "states": (steps + 1, self.scenario.vehicles, COLUMNS),
            "observations": (decisions + 1, self.scenario.observation_size),
            "terms": (decisions, 3),
            "policy": (decisions, N_ACTIONS),
            "q_values": (decisions, N_ACTIONS),
        }
        for name in (*REQUIRED, *OPTIONAL):
            array, shape = getattr(self, name), shapes.get(name, (decisions,))
            is_right = array is None or array.shape == shape
            require(is_right, f"This rollout's {name} have shape {np.shape(array)}, not {shape}: record it again.")
        require(
            (decisions - 1) * per_decision < steps <= decisions * per_decision,
            f"This rollout has {steps} simulation steps for {decisions} decisions: record it again.",
        )

    @property
    def times(self) -> np.ndarray:
        """The time of each state in seconds, (S + 1,)."""
        return np.arange(len(self.states)) * self.scenario.clock.dt

    @property
    def cars(self) -> np.ndarray:
        """The cars' states at each decision, (T, vehicles, 10)."""
        return self.states[:: self.scenario.clock.steps][: len(self.actions)]

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
        header = {name: getattr(self, name) for name in ("label", "rule_p", "provenance")}
        header |= {"format": Header.FORMAT, "seed": int(self.seed), "accident": int(self.accident)}
        header["scenario"] = asdict(self.scenario)
        names = (*REQUIRED, *OPTIONAL)
        arrays = {name: getattr(self, name) for name in names if getattr(self, name) is not None}
        write_arrays(path, {**arrays, "header": np.array(json.dumps(header))})
        return Path(path)

    @classmethod
    def load(cls, path: Path) -> "Rollout":
        """Read and check a rollout. Raises BootcourseError, with the file and the remedy, if it is damaged."""
        is_one = Path(path).suffix == ".npz" or not Path(path).is_file()  # a missing file has its own sentence
        arrays: dict[str, Any] = read_arrays(path, RECORD_AGAIN) if is_one else {}
        if "header" not in arrays:
            raise BootcourseError(f"{path} is not a rollout: record one with `bootcourse drive`.")
        if odd := (arrays.keys() - set(OPTIONAL)) ^ {*REQUIRED, "header"}:
            raise BootcourseError(
                f"{path} is incomplete or of another version (see {', '.join(sorted(odd))}): {RECORD_AGAIN}."
            )
        with decoding(path, RECORD_AGAIN):
            header = msgspec.structs.asdict(parse(str(arrays.pop("header")), Header, path, RECORD_AGAIN))
            del header["format"]
            return cls(**header, **arrays)


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


def _check_array(name: str, array) -> None:
    """Raise BootcourseError unless it is an array of finite numbers, whole and in range where they are numbers of
    actions, lanes or reasons, or probabilities."""
    kinds = "iu" if name in HIGHEST else "iuf"
    is_array = isinstance(array, np.ndarray) and array.ndim > 0 and array.dtype.kind in kinds
    require(is_array, f"This rollout's {name} are not {'whole ' * (name in HIGHEST)}numbers in a row: record it again.")
    low, high = (0, HIGHEST[name]) if name in HIGHEST else (0, 1 + 1e-6) if name == "policy" else (-LARGEST, LARGEST)
    is_within = bool(((array >= low) & (array <= high)).all())  # float32 probabilities are rounded
    require(is_within, f"This rollout's {name} hold NaN or a number outside {low:g}..{high:g}: record it again.")
