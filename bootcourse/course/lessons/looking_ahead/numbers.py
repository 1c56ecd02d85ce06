"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
from scipy.stats import wilcoxon

from bootcourse.course import shipped as course
from bootcourse.course.lessons.looking_ahead import explorable, figures, imagined_road
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.episodes.lookahead import lookahead, nine_drives
from bootcourse.episodes.record import Rollout, record
from bootcourse.policies import Policy
from bootcourse.research.experiments import learned_model
from bootcourse.research.experiments.lookahead import Cell, shipped_actors
from bootcourse.research.paper import earned_at  # noqa: F401 (for the expressions)
from bootcourse.research.results import Results
from bootcourse.research.tables import markdown
from bootcourse.road.state import EGO, TRAP_1, Accident, X, Y
from bootcourse.scenario import ACTION_NAMES, DEFAULT, N_ACTIONS
from tools.course.known import shipped_experiment

LATE = "everything a second late"
NOISE, VISIBLE = "places off by 1 m, speeds by 0.5 m/s", "only the four visible cars"
WRONG = list(figures.MEANINGS)  # of the study's models
TO_THE_RIGHT = [i for i, name in enumerate(ACTION_NAMES) if name.endswith("right")]


@cache
def shipped() -> dict:
    """The experiment's cells."""
    return shipped_experiment("look-ahead")


def each(base: str, form: str, measure: str, model: str = "exact") -> np.ndarray:
    """The accidents, or another measure, of each agent of a base policy, (agents,)."""
    return shipped()[Cell(base, form, model=model).name].measured[measure]


def accidents(base: str, form: str = "rollouts", model: str = "exact") -> int:
    """The accidents of all agents of a base policy in one form."""
    return int(each(base, form, "accidents", model).sum())


def drives(base: str, form: str = "rollouts", model: str = "exact") -> int:
    """The drives of all these agents."""
    return int(each(base, form, "roads", model).sum())


def per_thousand(base: str, form: str = "rollouts", model: str = "exact") -> float:
    """Accidents in 1,000 drives."""
    return 1000 * accidents(base, form, model) / drives(base, form, model)


def less_safe(base: str) -> np.ndarray:
    """Which agents of a base policy have more accidents with the look-ahead than alone, (agents,)."""
    return each(base, "rollouts", "accidents") > each(base, "alone", "accidents")


def outs(base: str, form: str = "rollouts") -> np.ndarray:
    """The share of drives that end ahead of trap 1, of each agent of a base policy."""
    return each(base, form, "success")


def worse_than_alone(base: str, form: str = "rollouts") -> int:
    """With how many of the lesson's wrong models a base policy crashes more often in one form than alone."""
    return sum(per_thousand(base, form, model) > per_thousand(base, "alone") for model in WRONG)


def worths() -> np.ndarray:
    """W at every speed that the car can have."""
    return imagined_road.worth(np.linspace(0, DEFAULT.ego.max_speed, 401))


def led_out(success: np.ndarray) -> int:
    """How many of the nine that stay behind alone get out in more than a tenth of their drives: success (agents,)."""
    return int((success[outs("sac", "alone") < 0.01] > 0.1).sum())


def errors_table() -> str:
    """The wrong models and what is wrong in them, as Markdown."""
    return markdown(["the imagined road", "what is wrong"], [[*pair] for pair in figures.MEANINGS.values()])


@cache
def trapped_futures() -> np.ndarray:
    """Of all nine agents that stay behind, on two roads: whether each future ends ahead of trap 1, (decisions, 9)."""
    agents, found = shipped_actors("sac"), []
    for seed in np.flatnonzero(outs("sac", "alone") < 0.01):
        policy = agents[seed].as_policy()
        cars = np.concatenate([drive.cars[: len(drive.actions)] for drive in record(policy, held_out_seeds(15, 2))])
        decide, actions = imagined_road.decide_by(policy), np.tile(np.arange(N_ACTIONS), len(cars))
        cars = cars.repeat(N_ACTIONS, axis=0)
        for _ in range(10):
            cars = imagined_road.step(cars, actions)[0]
            actions = decide(cars)
        found.append((cars[:, EGO, X] > cars[:, TRAP_1, X]).reshape(-1, N_ACTIONS))
    return np.concatenate(found)


@cache
def free_futures() -> np.ndarray:
    """How many of the nine have no accident for ten seconds at each decision of a drive that crashes, (decisions,).

    It is one of the agent of plain SAC that crashes most often with the look-ahead, and looks ahead.
    """
    policy = shipped_actors("sac")[int(each("sac", "rollouts", "accidents").argmax())].as_policy()
    return explorable.ways_out(record(lookahead(policy), [held_out_seeds(15, 47)[-1]])[0], policy)


def too_late() -> int:
    """At how many of its last decisions no future is free."""
    return int((free_futures()[::-1] > 0).argmax())


@cache
def learning(share: float | None = None) -> Results:
    """The ten agents that learned a model of the road, from drives with a share of random actions if one is given."""
    return learned_model.together(shipped_experiment(learned_model.NAME), share)


def in_last_model() -> np.ndarray:
    """Accidents in 1,000 drives of each that looks ahead in the model of the look-ahead's drives, too, (agents,)."""
    return learned_model.per_thousand(learning(), figures.LEARNED_FORM)[:, -1]


def by_round() -> str:
    """Accidents in each round's model of the look-ahead's drives, means over the agents, as Markdown."""
    means = learned_model.per_thousand(learning(), figures.LEARNED_FORM).mean(axis=0)
    drives = [f"{learned_model.DRIVES * (number + 1):,}" for number in range(len(means))]
    return markdown(
        ["drives so far", "accidents in 1,000"],
        [[so_far, f"{mean:,.0f}"] for so_far, mean in zip(drives, means, strict=True)],
    )


def control(share: float | None = None) -> np.ndarray:
    """Those of each whose model learned from drives without a look-ahead, (agents,)."""
    return learned_model.per_thousand(learning(share), figures.LEARNED_FORM, control=True).ravel()


def learned_without(share: float | None = None) -> float:
    """Their mean."""
    return float(control(share).mean())


def alone() -> np.ndarray:
    """Those of the same agents alone, on the same roads, (agents,)."""
    return np.array(learned_model.alone())


KINDS = ("last model", None, *learned_model.RANDOM)  # of drives that a model learned from, the figure's lowest first


def under_shield(kind: str | float | None) -> np.ndarray:
    """Accidents in 1,000 drives of each under the shield, in a kind of learned model, (agents,)."""
    if kind == "last model":
        return learned_model.per_thousand(learning(), "shield")[:, -1]
    return learned_model.per_thousand(learning(kind), "shield", control=True).ravel()


def p_of_shield(kind: str | float | None) -> float:
    """p of the paired rank test of the ten agents' accidents under the shield, in a kind of model, against alone."""
    return float(wilcoxon(under_shield(kind) - alone()).pvalue)


def overruled(form: str) -> str:
    """In which share of the decisions the agents' action is replaced: the least and the most of the four kinds."""
    shares = []
    for kind in KINDS:
        last = kind == "last model"
        of = learning().notes if last else learning(kind).measured
        changed, decisions = (of[f"{form}, {name}"].reshape(10, -1)[:, -1].sum() for name in ("overruled", "decisions"))
        shares.append(100 * changed / decisions)
    low, high = min(shares), max(shares)
    return f"{low:.0f} to {high:.0f} %"


def learned_rows(share: float | None = None) -> np.ndarray:
    """The decisions that each model of the last round, or of a control with random actions, learned from, (agents,)."""
    return learning().notes["rows"][:, -1] if share is None else learning(share).measured["rows"]


@cache
def how_five_end() -> list[np.ndarray]:
    """How the drives of each bootstrapped agent that ships end on the lesson's 40 roads."""
    roads = held_out_seeds(15, 40)
    return [drive_episodes(agent.as_policy(), roads).accident for agent in course.shipped_agents("bootstrapped")]


def five_accidents() -> list[int]:
    """The accidents of each of them."""
    return [int((ends > 0).sum()) for ends in how_five_end()]


def first_agent() -> Policy:
    """The lesson's agent."""
    return course.shipped_agents("bootstrapped")[0].as_policy()


@cache
def first_collision() -> Rollout:
    """Its first collision, which the lesson shows."""
    return record(first_agent(), [held_out_seeds(15, 40)[int((how_five_end()[0] == Accident.COLLISION).argmax())]])[0]


@cache
def ways_out(seconds: int = 10) -> list[int]:
    """In this drive, for each decision: how many of its nine futures have no accident for so long."""
    return explorable.ways_out(first_collision(), first_agent(), seconds).tolist()


@cache
def later_ends(seconds: int) -> list[int]:
    """How the two futures of its last but one decision that are unhurt for ten seconds have ended after so many."""
    drive, policy = first_collision(), first_agent()
    cars = drive.cars[len(drive.actions) - 2][None]
    ten, later = (nine_drives(cars, policy, DEFAULT, most).accidents[0] for most in (10, seconds))
    return sorted(later[ten == 0].tolist())


def departs_within(seconds: int) -> int:
    """How many of the agent's 40 drives leave the road within so many seconds."""
    drives = record(first_agent(), held_out_seeds(15, 40))
    return sum(each.accident == Accident.ROAD_DEPARTURE and len(each.actions) <= seconds for each in drives)


def in_right_lane(drive: Rollout) -> np.ndarray:
    """At which decisions of a drive the car is in the right lane, (decisions,)."""
    return drive.cars[: len(drive.actions), EGO, Y] > (DEFAULT.road.lanes - 1.5) * DEFAULT.road.lane_width


@cache
def right_lane() -> np.ndarray:
    """How often the agent takes each action in the right lane in the 200 drives of Round 4, (9,)."""
    drives = record(first_agent(), held_out_seeds(41, 200))
    actions = np.concatenate([drive.actions[in_right_lane(drive)] for drive in drives])
    return np.bincount(actions, minlength=N_ACTIONS)


def steered_off_the_road() -> np.ndarray:
    """At which decisions of the first collision "keep right" and "accelerate right" both leave the road."""
    ends = nine_drives(first_collision().cars, first_agent(), DEFAULT).accidents
    return (ends[:, TO_THE_RIGHT[1:]] == Accident.ROAD_DEPARTURE).all(axis=1)
