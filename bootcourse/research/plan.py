"""The lists of jobs that a study consists of: all methods in one scenario, or the variations of an experiment."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from pkgutil import resolve_name

from bootcourse.errors import BootcourseError, check_known
from bootcourse.learn.settings import SETTINGS, settings_for, with_seeds
from bootcourse.methods import ABLATION, AFTER, BASELINES
from bootcourse.research.jobs import BoundJob, Job, LessonJob, StayingJob
from bootcourse.research.teachers import RULE
from bootcourse.scenario import CALIBRATED, DEFAULT, Scenario

SEEDS, TESTS = 10, 1000  # of training, in a study of all methods; held-out episodes of each agent
GROUP = 10  # seeds that train side by side: with 5, each costs a third more
PLANNER, ROADS = "planner", 50  # held-out roads that one job of the planner searches
VARIED = ("sac", "soft", "demos", "bootstrapped")  # the paper's ablation
BEYOND = tuple(method for method in AFTER if method != "dagger")  # DAgger is in the experiment `teachers`


@dataclass(frozen=True)
class Study:
    """All methods in one scenario with one setting."""

    scenario: Scenario
    changes: dict = field(default_factory=dict)  # settings that differ from the defaults
    episodes: int = 2000  # of training


STUDIES = {
    "default": Study(DEFAULT),
    "calibrated": Study(CALIBRATED),
    "paper": Study(DEFAULT, SETTINGS["paper"], 1200),
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


def study_jobs(study: str, methods: Sequence[str], seeds: int, tests: int, episodes: int = 0) -> list:
    """Every method with its training seeds, GROUP at a time; "planner" is the bound, ROADS roads at a time.

    study: a name of `STUDIES`. episodes: of training, 0 for the study's own number.
    """
    plan = STUDIES[study]
    scenario, jobs = plan.scenario, []
    for method, first in product((m for m in methods if m != PLANNER), range(0, seeds, GROUP)):
        group = with_seeds(settings_for(method, **plan.changes), min(GROUP, seeds - first), first)
        name = f"{study}/{method}-{first}-{first + len(group) - 1}"
        jobs.append(Job(name, tuple(group), scenario, episodes or plan.episodes, tests))
    if PLANNER not in methods or study != scenario.name:  # the bound depends on the scenario alone
        return jobs
    for first in range(0, tests, ROADS):
        name = f"bound-{scenario.name}/{first:04}"
        jobs.append(BoundJob(name, scenario, first, min(ROADS, tests - first)))
    return [*jobs, StayingJob(f"staying-{scenario.name}/gamma-0.8", scenario, roads=min(ROADS, tests))]


@dataclass(frozen=True)
class Variation:
    """Some methods of the ablation with something changed."""

    changes: dict = field(default_factory=dict)  # of the settings
    scenario: Scenario = DEFAULT
    methods: tuple[str, ...] = VARIED
    episodes: int = 0  # of training; 0: the experiment's number
    teacher: str = RULE  # a name of `teachers.TEACHERS`


@dataclass(frozen=True)
class Experiment:
    """Variations that are run with the same seeds and number of episodes."""

    variations: dict[str, Variation]  # by name
    seeds: int
    episodes: int  # of training
    tests: int = TESTS  # held-out episodes

    def only(self, words: str) -> "Experiment":
        """The variations that are named by their folder, by their teacher, or by their method if they have one.

        words: such as "planner-dagger" or "ppo_cloned, soft"; "" for all. Raises BootcourseError for an unknown name.
        """
        names = {}
        for variation, one in self.variations.items():
            names[variation] = {folder(variation), one.teacher, *(one.methods if len(one.methods) == 1 else ())}
        return replace(self, variations=chosen(self.variations, names, words))

    def jobs(self, name: str, seeds: int = 0, episodes: int = 0, tests: int = 0) -> list[Job]:
        """One job for each variation, its agents side by side. 0: the experiment's own number."""
        jobs = []
        for variation, one in self.variations.items():
            agents = [a for m in one.methods for a in with_seeds(settings_for(m, **one.changes), seeds or self.seeds)]
            where, trained = f"{name}/{folder(variation)}", episodes or one.episodes or self.episodes
            tested = tests or self.tests
            jobs.append(Job(where, tuple(agents), one.scenario, trained, tested, runs=False, teacher=one.teacher))
        return sorted(jobs, key=lambda job: -sum(job.settings[0].hidden) * job.settings[0].updates)  # the longest first


@dataclass(frozen=True)
class LessonExperiment:
    """Agents that a function of its own trains, mostly for a lesson: {variation: the arguments of the function}."""

    function: str  # "module:function", see `jobs.LessonJob`
    variations: dict[str, dict]

    def only(self, words: str) -> "LessonExperiment":
        """The variations that are named by their folder or by an argument; "" for all.

        Raises BootcourseError for an unknown name.
        """
        names = {
            variation: {folder(word) for word in (variation, *arguments.values()) if isinstance(word, str)}
            for variation, arguments in self.variations.items()
        }
        return replace(self, variations=chosen(self.variations, names, words))

    def jobs(self, name: str, seeds: int = 0, episodes: int = 0, tests: int = 0) -> list[LessonJob]:
        """One job for each variation. 0: the number that stands among its arguments.

        Raises BootcourseError for a number that is not an argument.
        """
        numbers = {word: n for word, n in (("seeds", seeds), ("episodes", episodes), ("tests", tests)) if n}
        jobs = []
        for variation, arguments in self.variations.items():
            if fixed := [f"--{word}" for word in numbers if word not in arguments]:
                raise BootcourseError(f"The experiment {name} fixes its numbers: leave out {' and '.join(fixed)}.")
            jobs.append(LessonJob(f"{name}/{folder(variation)}", self.function, arguments | numbers))
        return jobs


EXPERIMENTS = {  # "module:name" of each, imported when it is used
    "sensitivity": "bootcourse.research.variations:SENSITIVITY",
    "clocks": "bootcourse.research.clocks:EXPERIMENT",
    "ablations": "bootcourse.research.variations:ABLATIONS",
    "longer-view": "bootcourse.research.variations:LONGER_VIEW",
    "teachers": "bootcourse.research.teacher_worth:EXPERIMENT",
    "beyond-search": "bootcourse.research.equal_decisions:SEARCH",
    "beyond": "bootcourse.research.equal_decisions:EXPERIMENT",
    "elsewhere": "bootcourse.research.elsewhere:EXPERIMENT",
    "checks": "bootcourse.research.checks:EXPERIMENT",
    "look-ahead": "bootcourse.research.lookahead:EXPERIMENT",
    "distil": "bootcourse.research.distil:EXPERIMENT",
    "bug-hunt": "bootcourse.course.lessons.bug_hunt.bugs:EXPERIMENT",
    "students": "bootcourse.course.lessons.your_teacher.taught_agents:EXPERIMENT",
    "second-trap": "bootcourse.course.lessons.the_second_trap.ppo_kinds:EXPERIMENT",
    "easier": "bootcourse.course.lessons.the_barrier.easier:EXPERIMENT",
    "reachable-entropy": "bootcourse.course.lessons.imitation.reachable_entropy:EXPERIMENT",
}


def experiment_named(name: str) -> Experiment | LessonExperiment:
    """The experiment of that name. Raises BootcourseError for an unknown one."""
    check_known("Experiment", name, EXPERIMENTS)
    return resolve_name(EXPERIMENTS[name])


def chosen(variations: dict, names: dict[str, set[str]], words: str) -> dict:
    """The variations that words such as "ppo_cloned, soft" name, all for "". names: of each variation."""
    wanted, known = {word.strip() for word in words.split(",")} - {""}, sorted(set().union(*names.values()))
    for word in sorted(wanted):
        check_known("Part", word, known)
    return {name: one for name, one in variations.items() if not wanted or wanted & names[name]}


def folder(name: str) -> str:
    """A name as a folder, of letters, digits and any of . _ - : "γ = 0.9" -> "gamma-0.9"."""
    words = {"γ": "gamma", "β": "beta", "ξ": "xi", "α": "alpha", "η": "eta", "π̃": "stochastic-rule", "μ": "rule"}
    for letter, word in (words | {"1/4": "quarter", "m/s": ""}).items():
        name = name.replace(letter, word)
    words = (re.sub(r"[^\w.-]", "", word) for word in name.split() if word not in ("x", "at"))
    return "-".join(word for word in words if word)
