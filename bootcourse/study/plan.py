"""The lists of jobs that a study consists of."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import product

from bootcourse.errors import BootcourseError, did_you_mean
from bootcourse.learn.settings import Settings, settings_for, with_seeds
from bootcourse.methods import ABLATION, BASELINES
from bootcourse.scenario import DEFAULT, Scenario
from bootcourse.study.jobs import BoundJob, Job, StayingJob

GROUP = 10  # seeds that train side by side: with 5, each costs a third more
PLANNER, ROADS = "planner", 50  # held-out roads that one job of the planner searches
VARIED = ("sac", "soft", "demos", "bootstrapped")  # the paper's ablation: the methods of every variation
P, XI, C = (0.5, 0.9, 0.99), (0.0, 20.0, 200.0, 2000.0), (0.0, 2.0, 5.0)  # the sweep


def methods_named(only: str) -> list[str]:
    """ "sac, soft" -> ["sac", "soft"]; "" -> all, the planner too. Raises BootcourseError for an unknown name."""
    everything = (*BASELINES, *ABLATION, PLANNER)  # the longest first
    names = [name.strip() for name in only.split(",") if name.strip()] or everything
    for name in names:
        if name not in everything:
            raise BootcourseError(f"Method {did_you_mean(name, everything)}.")
    return [name for name in everything if name in names]


def study_jobs(methods: Sequence[str], seeds: int, episodes: int, scenario: Scenario, tests: int) -> list:
    """Every method with its training seeds, GROUP at a time; "planner" is the bound, ROADS roads at a time."""
    jobs = []
    for method, first in product((m for m in methods if m != PLANNER), range(0, seeds, GROUP)):
        group = with_seeds(settings_for(method), min(GROUP, seeds - first), first)
        name = f"{scenario.name}/{method}-{first}-{first + len(group) - 1}"
        jobs.append(Job(name, tuple(group), scenario, episodes, tests))
    for first in range(0, tests, ROADS) if PLANNER in methods else ():
        name = f"bound-{scenario.name}/{first:04}"
        jobs.append(BoundJob(name, scenario, first, min(ROADS, tests - first)))
    if PLANNER in methods:
        jobs.append(StayingJob(f"staying-{scenario.name}/gamma-0.8", scenario, roads=min(ROADS, tests)))
    return jobs


def variations() -> dict[str, tuple[Scenario, dict]]:
    """What the paper leaves open, and three of its choices: {name: (scenario, settings that differ)}."""

    def traps(speed):
        return replace(DEFAULT, name=f"traps-{speed}", traps=replace(DEFAULT.traps, speed=speed)), {}

    def traffic(name, **changes):
        return replace(DEFAULT, name=name, traffic=replace(DEFAULT.traffic, **changes)), {}

    return {
        "as it is": (DEFAULT, {}),
        "traps at 10.3 m/s": traps(10.3),
        "traps at 10.6 m/s": traps(10.6),
        "traps at 11 m/s": traps(11.0),
        "no traffic": traffic("no-traffic", cars=0),
        "3 cars": traffic("3-cars", cars=3),
        "12 cars": traffic("12-cars", cars=12),
        "6 cars, twice as close": traffic("close", lead=20.0, headway=20.0),
        "network 32 x 32": (DEFAULT, {"hidden": (32, 32)}),
        "network 128 x 128": (DEFAULT, {"hidden": (128, 128)}),
        "1 update for each decision": (DEFAULT, {"updates": 4}),
        "demonstrations driven by π̃": (DEFAULT, {"stochastic_demonstrations": True}),
        "target entropy 0.3": (DEFAULT, {"target_entropy": 0.3}),
        "target entropy 1": (DEFAULT, {"target_entropy": 1.0}),
        "γ = 0.9": (DEFAULT, {"gamma": 0.9}),
        "γ = 0.95": (DEFAULT, {"gamma": 0.95}),
        "γ = 0.99": (DEFAULT, {"gamma": 0.99}),
        "γ = 0.9, target entropy 0.3": (DEFAULT, {"gamma": 0.9, "target_entropy": 0.3}),
    }


def sensitivity_jobs(seeds: int, episodes: int, tests: int) -> list[Job]:
    """One job for each variation: the ablation's methods, side by side."""
    jobs = []
    for name, (scenario, changes) in variations().items():
        agents = [agent for method in VARIED for agent in with_seeds(settings_for(method, **changes), seeds)]
        jobs.append(Job(f"sensitivity/{folder(name)}", tuple(agents), scenario, episodes, tests, runs=False))
    return sorted(jobs, key=lambda job: -sum(job.settings[0].hidden) * job.settings[0].updates)  # the longest first


def folder(name: str) -> str:
    """A name as a folder: "γ = 0.9" -> "gamma-0.9"."""
    plain = name.replace("γ", "gamma").replace("π̃", "stochastic-rule").replace(",", "")
    return "-".join(word for word in plain.split() if word not in ("=", "x", "at", "m/s"))


def sweep_settings(p: Sequence[float] = P, xi: Sequence[float] = XI, c: Sequence[float] = C) -> list[Settings]:
    """One for each combination that can differ. Without ξ nothing depends on p, so that is run once."""
    wanted = [(a if x else p[0], x, b) for a, x, b in product(p, xi, c)]
    return [settings_for("bootstrapped", rule_p=a, xi_multiplier=x, bonus=b) for a, x, b in dict.fromkeys(wanted)]


def sweep_jobs(seeds: int, episodes: int, tests: int, scenario: Scenario = DEFAULT, together: int = 10) -> list[Job]:
    """The sweep in a few large jobs: its agents differ in p, ξ and c, and still train side by side."""
    agents = [agent for settings in sweep_settings() for agent in with_seeds(settings, seeds)]
    parts = [tuple(agents[i : i + together]) for i in range(0, len(agents), together)]
    return [Job(f"sweep/{i:02}", part, scenario, episodes, tests, runs=False) for i, part in enumerate(parts)]
