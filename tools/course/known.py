"""What an expression in a lesson's text may name: numpy, the library, and a few short cuts to what ships.

What takes long to load or to drive is kept for the next expression.
"""
# ruff: noqa: F401 (what is imported here is for the expressions)

import dataclasses
import math
import re
from functools import cache

import gymnasium as gym
import numpy as np
import torch
from scipy import stats

from bootcourse.course import shipped
from bootcourse.course.lessons import registry
from bootcourse.course.lessons.bug_hunt import bugs
from bootcourse.course.lessons.the_barrier import chain
from bootcourse.course.lessons.the_barrier.chain import leaving
from bootcourse.course.lessons.the_rule import tracking
from bootcourse.course.lessons.the_second_trap import ppo_kinds, second_trap
from bootcourse.course.lessons.traffic import simulation as traffic
from bootcourse.course.lessons.your_teacher import example_teachers, taught_agents
from bootcourse.course.lessons.your_teacher.driven_out import OUT, drive_out
from bootcourse.course.own_learner import parts_of
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.episodes.words import overtaken
from bootcourse.errors import BootcourseError
from bootcourse.files import read_arrays
from bootcourse.learn import bootstrap, sac
from bootcourse.learn.bootstrap import demonstration_share
from bootcourse.learn.settings import settings_for
from bootcourse.learn.teachers import teacher_policy, toward
from bootcourse.methods import METHODS
from bootcourse.policies import idle_policy, plan_policy, random_policy, rule_policy, stochastic_rule_policy
from bootcourse.research import beyond, report
from bootcourse.research import clocks as study_clocks
from bootcourse.research.checks import CHECKS
from bootcourse.research.clocks import pattern
from bootcourse.research.paper import EPISODES, PRINTED, paper_interval
from bootcourse.research.planner import Search, discounted_values, plan_episodes
from bootcourse.research.results import KINDS, Results
from bootcourse.research.teachers import LATE, TEACHERS
from bootcourse.road import formulas, observation
from bootcourse.road.formulas import centring_reward, speed_reward
from bootcourse.road.state import CRASHED, EGO, LANE, SPEED, TRAP_1, TRAP_2, Accident, X, Y
from bootcourse.rule import HEADING_COST, Reason, stochastic_rule, target_speed
from bootcourse.scenario import ACTION_NAMES, CALIBRATED, DEFAULT, N_ACTIONS, RULE_P
from bootcourse.statistics import ESCAPES, escapes, improvement, interval, iqm, rate
from bootcourse.storage.assets import FOLDER
from tools.course.reference import lessons
from tools.course.source import NOTEBOOKS, read

shipped_results = cache(shipped.shipped_results)
shipped_runs = cache(shipped.shipped_runs)
shipped_drive = cache(shipped.shipped_drive)
shipped_experiment = cache(shipped.shipped_experiment)
shipped_teachers = cache(shipped.shipped_teachers)
hunt = cache(bugs.Hunt)  # lesson 13's agents
ROAD = 10  # the road that most lessons show
SETTINGS = settings_for("bootstrapped")  # the paper's


def roads() -> int:
    """How many held-out roads each agent of the study has driven."""
    return shipped_results().sizes[0]


def minutes(*numbers: int) -> int:
    """The time of these lessons together, as they state it at their top."""
    texts = [lessons()[number].read_text(encoding="utf-8") for number in numbers]
    return sum(int(re.search(r"^# \*\*Time\*\* (\d+) minutes", text, re.M)[1]) for text in texts)


def talk(*numbers: int) -> int:
    """The minutes that the instructor's pages of these lessons have for talk."""
    return sum(cell.metadata.get("minutes", 0) for number in numbers for cell in read(lessons()[number]))


def work(*names: str) -> int:
    """The minutes of these exercises."""
    return sum(registry()[name].minutes for name in names)


@cache
def bound() -> np.ndarray:
    """The best return that the planner found on each of those roads."""
    return read_arrays(FOLDER / "bound-default.npz")["returns"]


@cache
def by_rule(road: int = ROAD):
    """The rule's drive on one road."""
    return record(rule_policy(DEFAULT), [road])[0]


NO_BRAKING = [3, 3, 5, 3, 5, 5, 5, 3, 7, 7, 7, 7, 7]  # lesson 1: a plan that changes lanes behind trap 2 at once


@cache
def without_braking() -> tuple[np.ndarray, np.ndarray]:
    """That plan on the held-out roads: D2 (m), and whether it gets out, each (roads,)."""
    plan = plan_policy([ACTION_NAMES[action] for action in NO_BRAKING])
    drives = record(plan, held_out_seeds(1, roads()))
    starts = np.array([drive.states[0, TRAP_2, X] - drive.states[0, EGO, X] for drive in drives])
    return starts, np.array([drive.success for drive in drives])


@cache
def idle(road: int = ROAD):
    """Nobody's drive on one road: 4, "keep straight", for ever."""
    return record(idle_policy, [road])[0]


@cache
def of(method: str) -> Results:
    """The study's agents of a method; "rule" is a method, too."""
    return report.rule_results(DEFAULT, roads()) if method == "rule" else shipped_results().of(method)


def escaped(method: str, scenario: str = "default") -> int:
    """How many agents of a method escape."""
    return escapers(of(method) if scenario == "default" else shipped_results(scenario), method)


def varied() -> dict[str, Results]:
    """The study's agents with one number changed, by what was changed."""
    return shipped_experiment("sensitivity")


def escaped_with(change: str, method: str) -> int:
    """How many of the few agents of a method escape with a number changed."""
    return escapers(varied()[change], method)


def ablations() -> dict[str, Results]:
    """The ten agents of each method with one choice of the method changed, by what was changed."""
    return shipped_experiment("ablations")


@cache
def clocks() -> dict[tuple[str, str], Results]:
    """The four methods' ten agents each, by (updates per decision, who drives the demonstrations): ("2", "π̃")."""
    return study_clocks.cells(shipped_experiment("clocks"))


LATER = ("ppo", "ppo_cloned", "ppo_kl", "ppo_residual", "rlpd", "ibrl", "pex", "jsrl")  # those of lesson 16


def later(method: str) -> Results:
    """The ten agents of a method that the paper does not train."""
    return shipped_experiment("beyond")[method]


def longer() -> Results:
    """The ten agents of the paper's method with a longer view, a smaller bonus and larger batches."""
    return shipped_experiment("longer-view")["γ = 0.95"]


def safer() -> dict[str, Results]:
    """The ten agents of PPO after cloning with something more against accidents, by what it is."""
    return shipped_experiment("safe")


BEST = "accident cost and shield by hand, twice as long"  # of `safer`
REMEMBERS = "accident cost, shield by hand and memory, twice as long"
ALONE = ("accident cost", "multiplier", "restarts", "shield by hand", "γ = 0.995", "memory")
ALONE += ("distributional critic",)  # the learned mask is the one other that an agent has alone


def p_safer(kind: str) -> float:
    """The p of a rank test: the accidents of such agents against those of PPO after cloning with nothing more."""
    accidents = [its.scores("accident") for its in (safer()[kind], later("ppo_cloned"))]
    return float(stats.mannwhitneyu(*accidents).pvalue)


def crashed(results: Results) -> float:
    """How many of 1,000 of these agents' held-out drives end in an accident."""
    return 10 * accident_percent(results)


def with_and_without() -> list[Results]:
    """The agents of `safer`, and those with nothing more."""
    return [later("ppo_cloned"), *safer().values()]


def crashes_on_roads() -> np.ndarray:
    """How many of these agents crash on each of the held-out roads, (1000,)."""
    return np.concatenate([its.tested["accident"] > 0 for its in with_and_without()]).sum(axis=0)


def worst_roads(n: int) -> np.ndarray:
    """The n roads on which most of them crash."""
    return np.argsort(-crashes_on_roads(), kind="stable")[:n]


def half_of_the_crashes() -> int:
    """On how many roads half of the crashes happen, at least."""
    crashes = np.sort(crashes_on_roads())[::-1]
    return int(np.searchsorted(np.cumsum(crashes), crashes.sum() / 2)) + 1


@cache
def three_abreast(road: int) -> bool:
    """Whether lesson 15's agent crashes on this road beside three slower cars, one in each lane, 5 m apart at most."""
    agent = ppo_kinds.agent_of("cloned").as_policy()
    end = record(agent, [held_out_seeds(1, 1000)[road]])[0].states[-1]
    three = end[1:][np.argsort(abs(end[1:, X] - end[EGO, X]))[:3]]
    slower = three[:, SPEED].max() < end[EGO, SPEED] - 2
    return bool(set(three[:, LANE]) == {0, 1, 2} and np.ptp(three[:, X]) < 5 and slower and end[EGO, CRASHED])


def first_episodes(method: str, episodes: int = 50) -> float:
    """How many decisions these agents' first episodes take altogether, the mean over agents."""
    return float(later(method).curves["decisions"][:, :episodes].sum(axis=1, dtype=float).mean())


def learned(method: str) -> np.ndarray:
    """The decisions until each agent gets out in 95 % of 50 episodes, inf if it does not, see `study.beyond`."""
    return beyond.spent(later(method))


def taught(teacher: str, method: str = "ppo_cloned") -> Results:
    """The ten agents of a method that a teacher of the experiment `teachers` taught."""
    return shipped_teachers()[teacher, method]


def taught_cost(teacher: str) -> np.ndarray:
    """`learned` of the PPO agents that began as clones of a teacher."""
    return beyond.spent(taught(teacher))


@cache
def teacher_drives(teacher: str):
    """Such a teacher's own drives on 200 of the study's held-out roads."""
    return drive_episodes(teacher_policy(TEACHERS[teacher].rule), held_out_seeds(1, 200))


def teachers_success(teacher: str) -> float:
    """The share of them that end ahead."""
    return float(teacher_drives(teacher).success.mean())


def teachers_accidents(teacher: str) -> float:
    """The share of them that end in an accident."""
    return float((teacher_drives(teacher).accident > 0).mean())


@cache
def rules_overtaking() -> np.ndarray:
    """When the rule is ahead of trap 1, in seconds on each of 100 held-out roads; inf where it is not."""
    drives = record(rule_policy(DEFAULT), held_out_seeds(1, 100))
    return np.array([overtaken(drive) or np.inf for drive in drives])


def accident_percent(results: Results) -> float:
    """The share of all held-out episodes of these agents that end in an accident, in %."""
    return 100 * float(results.episodes("accident").mean())


def driven(method: str) -> float:
    """The decisions of such an agent's whole training, the mean over agents."""
    return float(np.nansum(later(method).curves["decisions"], axis=1, dtype=float).mean())


def papers_cost() -> np.ndarray:
    """`learned` of the bootstrapped agents with the paper's setting."""
    return beyond.spent(shipped_results("paper").of("bootstrapped"))


def clocks_run_down(updates: str) -> float:
    """The episode in which the soft agents' ξ is down to a tenth, the median of ten."""
    return study_clocks.faded(clocks()[updates, "π̃"].of("soft").curves["xi"])


def clocks_out(updates: str) -> float:
    """The first 50 episodes in a row, by their end, in which a soft agent is ahead in most: the median of ten."""
    success = clocks()[updates, "π̃"].of("soft").curves["success"]
    most = np.array([np.convolve(curve, np.ones(50) / 50, "valid") > 0.5 for curve in success])
    return float(np.median(np.where(most.any(1), most.argmax(1) + 50, success.shape[1])))


escapers = Results.escapers  # (results, method): how many of a method's agents in these results escape


def fisher(first: int, second: int) -> float:
    """Fisher's p of two numbers of agents that escape, of ten each."""
    return float(stats.fisher_exact([[won, 10 - won] for won in (first, second)]).pvalue)


def p_changed(change: str, method: str) -> float:
    """Fisher's p of a method's agents that escape in the study against those with one choice changed."""
    return fisher(escaped(method), escapers(ablations()[change], method))


def accidents(method: str) -> float:
    """The share of a method's held-out episodes that end in an accident of any kind."""
    return float(of(method).episodes("accident").mean())


def code_of(lesson: str) -> str:
    """The source of another lesson."""
    return (NOTEBOOKS / "source" / f"{lesson}.py").read_text(encoding="utf-8")


def second_pays(speed: float, offset: float = 0.0) -> float:
    """The reward of a second at a speed (m/s), offset metres off the lane's centre, without steering."""
    w = DEFAULT.reward
    return formulas.weighted_reward(speed_reward(speed), centring_reward(offset), 0.0, w.w_v, w.w_y, w.w_theta)


def discounted(drive, gamma: float) -> float:
    """What a drive is worth at its start."""
    return float(gamma ** np.arange(len(drive.rewards)) @ drive.rewards)


@cache
def planned(beam: int, gamma: float, keep_lane: bool = False, road: int = ROAD) -> float:
    """What the planner's best drive on a road is worth."""
    return plan_episodes([road], search=Search(beam, gamma, keep_lane))[0].value


def undecided(method: str, first: int, last: int | None) -> float:
    """The mean effective number of actions of a method's agents in some of their training episodes."""
    return float(np.exp(of(method).curves["entropy"][:, first:last].mean()))


@cache
def rule_drives() -> list:
    """The rule's drives on the 60 roads of lesson 6."""
    return record(rule_policy(DEFAULT), range(60))


def way_out() -> tuple[float, float]:
    """After how many seconds the rule is in the free lane, and ahead of trap 1: medians of those drives."""
    cars = [drive.states[::2] for drive in rule_drives()]
    free = [np.argmax(each[:, EGO, LANE] == 0) for each in cars]
    ahead = [np.argmax(each[:, EGO, X] > each[:, TRAP_1, X]) for each in cars]
    return float(np.median(free)), float(np.median(ahead))


def rule_keeps_left(second: int) -> float:
    """The share of those drives in which the rule keeps its speed and steers left at a second."""
    keep_left = ACTION_NAMES.index("keep left")
    return float(np.mean([drive.actions[second] == keep_left for drive in rule_drives()]))


@cache
def clone_agrees(seed: int, second: int) -> float:
    """The share of 40 roads on which a clone of the study does at a second what the rule would do in its place."""
    drives = record(shipped_runs("bc")[seed].agent.as_policy(), range(40))
    return float(np.mean([drive.actions[second] == drive.rule_actions[second] for drive in drives]))


@cache
def discounted_scores(method: str) -> np.ndarray:
    """The shipped agents' discounted returns at their own γ, each the mean of 200 held-out roads: (agents,)."""
    agents, seeds = [run.agent for run in shipped_runs(method)], held_out_seeds(1, 200)
    return np.array([discounted_values(a.as_policy(), seeds, DEFAULT, a.settings.gamma).mean() for a in agents])


@cache
def by_chance():
    """Lesson 5's 5,000 random drives."""
    return drive_episodes(random_policy(np.random.default_rng(0)), held_out_seeds(6, 5000))


def free_road_seen(explore: float, gamma: float, walks: int = 30) -> int:
    """How many learners of lesson 5's chain have been on its free road, of which Q(3, 1) tells."""
    walked = (chain.learn_chain(chain.chances(explore, 1000, seed), gamma, 0.3, ()) for seed in range(walks))
    return sum(bool(q[3, 1] > 0) for q in walked)


@cache
def cooling_updates(part: float) -> int:
    """After how many of Adam's steps α is this part of its start if η = −1 and the entropy stays 0."""
    log_alpha = torch.zeros(1, dtype=torch.float64, requires_grad=True)
    optimiser, steps = torch.optim.Adam([log_alpha], lr=SETTINGS.alpha_lr), 0
    while log_alpha.item() > math.log(part):
        log_alpha.grad = log_alpha.detach().exp() * (0 - SETTINGS.target_entropy)
        optimiser.step()
        steps += 1
    return steps


@cache
def demonstrated_q() -> np.ndarray:
    """After training, what the shipped agents with demonstrations only think of the rule's actions, (agents,).

    The mean over the first 20 seconds of the rule's drives on 20 roads.
    """
    drives = rule_drives()[:20]
    seen = np.concatenate([drive.observations[:20] for drive in drives])
    did = np.concatenate([drive.actions[:20] for drive in drives])
    values = [run.agent.q_values(seen) for run in shipped_runs("demos")]
    return np.array([each[np.arange(len(did)), did].mean() for each in values])


def in_training(method: str, first: int, last: int | None) -> np.ndarray:
    """Each agent's success in some of its training episodes, (agents,)."""
    return of(method).curves["success"][:, first:last].mean(axis=1)


def losing(method: str) -> np.ndarray:
    """Which agents lose 20 points of success as the demonstrations end: 600 to 800 against 900 to 1,100, (agents,)."""
    return in_training(method, 900, 1100) < in_training(method, 600, 800) - 0.2


def tenth_of_xi(method: str) -> np.ndarray:
    """The training episodes in which α, and with it ξ, is first below a tenth of its start, for the shipped agents."""
    return np.array([int(np.argmax(run.curves["alpha"] < 0.1 * SETTINGS.alpha_init)) for run in shipped_runs(method)])


def nearest_to_iqm(method: str) -> float:
    """How far the interquartile mean of a method's returns is from the agent nearest to it."""
    returns = of(method).scores("returns")
    return float(np.abs(returns - iqm(returns)).min())


def with_one_agent(method: str) -> float:
    """Fisher's p of our agents that escape against the paper's row, if one agent stands behind that row."""
    won, theirs = escaped(method), int(PRINTED[method]["success"].mean >= 50)
    return float(stats.fisher_exact([[won, len(of(method)) - won], [theirs, 1 - theirs]]).pvalue)


def positive_target(method: str, measure: str, change: str = "entropy") -> np.ndarray:
    """Scores of a method's agents in the variations with a positive target entropy."""
    return np.concatenate([varied()[c].of(method).scores(measure) for c in varied() if change in c])


def ended_ahead(method: str, agents: int = 5) -> np.ndarray:
    """How many training episodes the agents that ship with their networks ended ahead of trap 1, (agents,)."""
    return of(method).curves["success"][:agents].sum(axis=1)


@cache
def checked(row: int, column: str) -> str:
    """What assets/checks.md says in a row of its table, the first is 0: "learner", "task", "published", ..."""
    table = [line.strip("| ").split(" | ") for line in (FOLDER / "checks.md").read_text("utf-8").splitlines()]
    names, _, *rows = [cells for cells in table if len(cells) > 1 or cells[0].startswith("---")]
    return dict(zip(["ours" if name.startswith("ours") else name for name in names], rows[row], strict=True))[column]


@cache
def teacher_exam(name: str):
    """How one of lesson 14's teachers drives on the exam's roads."""
    return example_teachers.examine(getattr(example_teachers, name)).episodes


@cache
def dense_escapes(name: str) -> float:
    """The share of lesson 14's roads with a dense left lane on which one of its teachers gets out unharmed."""
    rule = getattr(example_teachers, name)
    roads = registry()["watchful_rule"].all_arguments
    return float(np.mean([drive_out(rule, cars, scenario) == OUT for cars, scenario in roads]))


@cache
def students(teacher: str) -> dict:
    """What ships of the ten students of one of lesson 14's teachers, or of the ten that learned "alone"."""
    return taught_agents.reference()[teacher]


def student_escapes(teacher: str) -> int:
    """How many of these ten escape."""
    return int((students(teacher)["success"] >= ESCAPES).sum())


def teacher_tests() -> dict:
    """Holm's adjusted p-values against the ten that learned alone: {(teacher, score): p}."""
    names = list(taught_agents.TEACHERS)
    pairs = [(name, score) for name in names for score in ("success", "returns")]
    p = [stats.mannwhitneyu(students(name)[score], students("alone")[score]).pvalue for name, score in pairs]
    return dict(zip(pairs, taught_agents.holm(p), strict=True))


def ppo(kind: str) -> dict:
    """What ships of lesson 15's agents of a kind: "alone", "shaped" or "cloned"."""
    return ppo_kinds.reference()[kind]


def ppo_agents() -> int:
    """How many agents of each kind ship."""
    return len(ppo("alone")["success"])


def ppo_escapes(kind: str) -> int:
    """How many of them escape."""
    return int((ppo(kind)["success"] >= ESCAPES).sum())


@cache
def ppo_drive(kind: str = "alone", road: int = ROAD):
    """The first of these agents on one road."""
    return record(ppo_kinds.agent_of(kind).as_policy(), [road])[0]


def ppo_speeds(kind: str = "alone") -> np.ndarray:
    """Its speed (m/s) after each decision, (decisions,)."""
    return ppo_drive(kind).states[2::2, EGO, SPEED]


def ppo_gap(kind: str = "alone") -> np.ndarray:
    """How far (m) it is ahead of trap 1 then, (decisions,)."""
    cars = ppo_drive(kind).states[2::2]
    return cars[:, EGO, X] - cars[:, TRAP_1, X]


@cache
def two_situations(slow: float):
    """How a rule of two situations drives there: 12 m/s on the free lane, elsewhere slow (m/s) and one lane left."""

    def rule(cars, scenario):
        lane = int(cars[EGO, LANE])
        return toward(cars, 12.0 if lane == 0 else slow, max(0, lane - 1), scenario)

    return example_teachers.examine(rule).episodes


@cache
def lowest_speeds() -> list[float]:
    """Of lesson 2's eight drivers in a row, behind a leader that brakes to 4 m/s for 20 s."""
    ahead, found = np.repeat([10.0, 4.0, 10.0], [60, 40, 140]), []
    for _ in range(8):
        ahead = traffic.behind(ahead, v=10.0, gap=25.0)[:-1, 1]
        found.append(ahead.min())
    return found


def accepts_road(length: float) -> bool:
    """Whether the default scenario accepts a road of this length (m)."""
    try:
        dataclasses.replace(DEFAULT, road=dataclasses.replace(DEFAULT.road, length=length))
    except BootcourseError:
        return False
    return True
