"""The studies: all methods in one scenario, with the planner's bound, and the jobs that each consists of."""

from dataclasses import dataclass, field
from functools import partial
from itertools import product

import numpy as np

from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.errors import BootcourseError, check_known
from bootcourse.files import write_arrays, write_json
from bootcourse.learn.settings import SETTINGS, settings_for, with_seeds
from bootcourse.methods import ABLATION, AFTER, BASELINES
from bootcourse.research.cells import TESTS, train_and_test
from bootcourse.research.jobs import HELD_OUT, Job, Workplace
from bootcourse.research.planner import Search, is_staying_optimal, plan_episodes
from bootcourse.research.teachers import RULE
from bootcourse.scenario import CALIBRATED, DEFAULT, Scenario

SEEDS = 10  # of training
GROUP = 10  # seeds that train side by side: with 5, each costs a third more
PLANNER, ROADS = "planner", 50  # held-out roads that one job of the planner searches
BEYOND = tuple(method for method in AFTER if method != "dagger")  # DAgger is in the experiment `teachers`


@dataclass(frozen=True)
class Study:
    """All methods in one scenario with one setting."""

    name: str
    scenario: Scenario
    changes: dict = field(default_factory=dict)  # settings that differ from the defaults
    episodes: int = 2000  # of training

    def jobs(self, only: str = "", seeds: int = 0, episodes: int = 0, tests: int = 0) -> list[Job]:
        """Every method with its training seeds, `GROUP` at a time; the planner's bound, `ROADS` roads at a time.

        only: see `methods_named`. 0: the study's own number.
        """
        methods, seeds, tests, jobs = methods_named(only), seeds or SEEDS, tests or TESTS, []
        for method, first in product((m for m in methods if m != PLANNER), range(0, seeds, GROUP)):
            group = with_seeds(settings_for(method, **self.changes), min(GROUP, seeds - first), first)
            arguments = {"settings": tuple(group), "scenario": self.scenario, "episodes": episodes or self.episodes}
            arguments |= {"tests": tests, "teacher": RULE}
            name = f"{self.name}/{method}-{first}-{first + len(group) - 1}"
            jobs.append(Job(name, partial(train_and_test, keep_runs=True), arguments))
        if PLANNER in methods and self.name == self.scenario.name:  # the bound depends on the scenario alone
            jobs += bound_jobs(self.scenario, tests)
        return jobs


STUDIES = {
    study.name: study
    for study in (
        Study("default", DEFAULT),
        Study("calibrated", CALIBRATED),
        Study("paper", DEFAULT, SETTINGS["paper"], 1200),
    )
}


def methods_named(only: str) -> list[str]:
    """ "sac, soft" -> ["sac", "soft"]; "" -> all, the planner too. Raises BootcourseError for an unknown name."""
    everything = (*BASELINES, *ABLATION, PLANNER)  # the longest first
    names = [name.strip() for name in only.split(",") if name.strip()] or everything
    for name in names:
        if name in BEYOND:
            raise BootcourseError(f"Method '{name}' is not in this study: run `bootcourse study beyond --only {name}`.")
        check_known("Method", name, everything)
    return [name for name in everything if name in names]


def bound_jobs(scenario: Scenario, tests: int) -> list[Job]:
    """What the planner finds in a scenario: the best return on each held-out road, and whether it pays to leave."""
    jobs = []
    for first in range(0, tests, ROADS):
        arguments = {"scenario": scenario, "first": first, "episodes": min(ROADS, tests - first), "search": Search()}
        jobs.append(Job(f"bound-{scenario.name}/{first:04}", search_bound, arguments))
    asked = {"scenario": scenario, "gamma": 0.8, "roads": min(ROADS, tests), "beam": 200}  # the paper's γ
    return [*jobs, Job(f"staying-{scenario.name}/gamma-0.8", ask_staying, asked)]


def search_bound(at: Workplace, scenario: Scenario, first: int, episodes: int, search: Search) -> None:
    """Search for the best return on some of the held-out roads, from the `first` on."""
    plans = plan_episodes(held_out_seeds(HELD_OUT, first + episodes)[first:], scenario, search)
    returns, success = np.array([plan.value for plan in plans]), np.array([plan.success for plan in plans])
    write_arrays(at.job / "results.npz", {"first": np.array(first), "returns": returns, "success": success})


def ask_staying(at: Workplace, scenario: Scenario, gamma: float, roads: int, beam: int) -> None:
    """Ask the planner: at this γ, is staying behind the trap the best that a driver can do? On held-out roads."""
    staying = is_staying_optimal(held_out_seeds(HELD_OUT, roads), scenario, gamma, beam)
    write_json(at.job / "staying.json", vars(staying))
