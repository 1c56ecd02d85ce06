"""The lists of jobs that a study consists of."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import product

from bootcourse.errors import BootcourseError, check_known
from bootcourse.learn.settings import SETTINGS, Settings, settings_for, with_seeds
from bootcourse.methods import ABLATION, AFTER, BASELINES
from bootcourse.research.jobs import BoundJob, Job, LessonJob, StayingJob, named_function
from bootcourse.research.teachers import PLANNER as PLANS
from bootcourse.research.teachers import RULE, TEACHERS, teacher_named
from bootcourse.scenario import CALIBRATED, DEFAULT, Scenario

SEEDS, TESTS = 10, 1000  # of training, in a study of all methods; held-out episodes of each agent
GROUP = 10  # seeds that train side by side: with 5, each costs a third more
PLANNER, ROADS = "planner", 50  # held-out roads that one job of the planner searches
VARIED = ("sac", "soft", "demos", "bootstrapped")  # the paper's ablation
BEYOND = tuple(method for method in AFTER if method != "dagger")  # DAgger is in the experiment `teachers`
P, XI, C = (0.5, 0.9, 0.99), (0.0, 20.0, 200.0, 2000.0), (0.0, 2.0, 5.0)  # the sweep


# Each updates-per-decision setting of the experiment `clocks`. The paper prints neither updates nor roads.
UPDATES = {"1/4": {}, "1": {"envs_per_agent": 1}, "2": {"envs_per_agent": 1, "updates": 2},
           "4": {"envs_per_agent": 1, "updates": 4}}  # fmt: skip


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

    def __post_init__(self):
        teacher_named(self.teacher)


def _sensitivity() -> dict[str, Variation]:
    """What the paper leaves open, and three of its choices."""

    def traps(speed):
        return Variation(
            scenario=replace(DEFAULT, name=f"traps-{speed}", traps=replace(DEFAULT.traps, speed=speed)),
        )

    def traffic(name, **changes):
        return Variation(scenario=replace(DEFAULT, name=name, traffic=replace(DEFAULT.traffic, **changes)))

    return {
        "as it is": Variation(),
        "traps at 10.3 m/s": traps(10.3),
        "traps at 10.6 m/s": traps(10.6),
        "traps at 11 m/s": traps(11.0),
        "no traffic": traffic("no-traffic", cars=0),
        "3 cars": traffic("3-cars", cars=3),
        "12 cars": traffic("12-cars", cars=12),
        "6 cars, twice as close": traffic("close", lead=20.0, headway=20.0),
        "network 32 x 32": Variation({"hidden": (32, 32)}),
        "network 128 x 128": Variation({"hidden": (128, 128)}),
        "1 update for each decision": Variation({"updates": 4}),
        "demonstrations driven by π̃": Variation({"stochastic_demonstrations": True}),
        "target entropy 0.3": Variation({"target_entropy": 0.3}),
        "target entropy 1": Variation({"target_entropy": 1.0}),
        "γ = 0.9": Variation({"gamma": 0.9}),
        "γ = 0.95": Variation({"gamma": 0.95}),
        "γ = 0.99": Variation({"gamma": 0.99}),
        "γ = 0.9, target entropy 0.3": Variation({"gamma": 0.9, "target_entropy": 0.3}),
    }


def _clocks() -> dict[str, Variation]:
    """ξ = 200 α fades with the updates, β with the episodes: both clocks, and who drives the demonstrations."""
    variations = {}
    for updates, changes in UPDATES.items():
        variations[f"{updates} updates, no demonstrations"] = Variation(changes, methods=("sac", "soft"))
        for driver, stochastic in (("μ", False), ("π̃", True)):
            of_driver = changes | {"stochastic_demonstrations": stochastic}
            helped = Variation(of_driver, methods=("demos", "bootstrapped"))
            variations[f"{updates} updates, demonstrations by {driver}"] = helped
    return variations


def _ablations() -> dict[str, Variation]:
    """One choice of the method changed."""
    helped = ("demos", "bootstrapped")
    return {
        "KL in the actor only": Variation({"kl_in_target": False}, methods=("soft", "bootstrapped")),
        "β over 300 episodes": Variation({"beta_episodes": 300}, methods=helped),
        "β for ever": Variation({"beta_episodes": None}, methods=helped),
        "ξ stays at 2": Variation({"xi_fixed": 2.0}, methods=("soft",)),
    }


def _longer_view() -> dict[str, Variation]:
    """The paper's method with a longer view, a smaller bonus, a larger batch and two updates per decision."""
    saner = {**SETTINGS["paper"], "bonus": 0.5, "batch": 128}
    return {"γ = 0.95": Variation(saner | {"gamma": 0.95}, methods=("bootstrapped",))}


# Of each method in the experiment `teachers`: changes and training episodes. The minutes of one core are those of ten
# agents side by side, by the speed of their first 20 s. The planner takes 12.5 ms for a decision. Demonstrations by it
# add 6 minutes (2 where it takes the part of μ in π̃, whose drives end early), its labels of DAgger's 80 episodes 25.
# Labels for the 1,500 episodes of a method with a KL would take eight hours, so those two cells are left out. The rule
# with rollouts takes 0.2 ms for a decision.
TAUGHT = {
    "dagger": ({"updates": 6}, 80),  # 1 minute
    "ppo_cloned": ({}, 6000),  # 3 minutes
    "bootstrapped": ({}, 1500),  # 7 minutes
    "soft": ({}, 1500),  # 8 minutes
    "rlpd": ({}, 150),  # 15 minutes
}


def _teachers() -> dict[str, Variation]:
    """Five ways to use a teacher, with teachers from bad to perfect, a cell each."""
    return {
        f"{teacher}, {method}": Variation(changes, methods=(method,), episodes=episodes, teacher=teacher)
        for method, (changes, episodes) in TAUGHT.items()
        for teacher in TEACHERS
        if teacher != PLANS or method not in ("bootstrapped", "soft")
    }


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


EXPERIMENTS = {
    "sensitivity": Experiment(_sensitivity(), seeds=3, episodes=1500),
    "clocks": Experiment(_clocks(), seeds=10, episodes=1200),
    "ablations": Experiment(_ablations(), seeds=10, episodes=2000),
    "longer-view": Experiment(_longer_view(), seeds=10, episodes=1500),
    "teachers": Experiment(_teachers(), seeds=10, episodes=1500, tests=200),
}


@dataclass(frozen=True)
class LessonExperiment:
    """Agents that a function of a lesson trains: {variation: the arguments of the function}."""

    function: str  # "module:function", see `jobs.LessonJob`
    variations: dict[str, dict]

    def only(self, words: str) -> "LessonExperiment":
        """The variations that are named by their folder; "" for all. Raises BootcourseError for an unknown name."""
        names = {variation: {folder(variation)} for variation in self.variations}
        return replace(self, variations=chosen(self.variations, names, words))

    def jobs(self, name: str, seeds: int = 0, episodes: int = 0, tests: int = 0) -> list[LessonJob]:
        """One job for each variation. Raises BootcourseError for another number of seeds or episodes."""
        if seeds or episodes or tests:
            raise BootcourseError(f"The lesson fixes the numbers of {name}: leave out --seeds, --episodes and --tests.")
        return [
            LessonJob(f"{name}/{folder(variation)}", self.function, arguments)
            for variation, arguments in self.variations.items()
        ]


LESSON_EXPERIMENTS = {  # "module:name" of a LessonExperiment, imported when it is used
    "bug-hunt": "bootcourse.course.lessons.bug_hunt.bugs:EXPERIMENT",
    "students": "bootcourse.course.lessons.your_teacher.taught_agents:EXPERIMENT",
    "second-trap": "bootcourse.course.lessons.the_second_trap.ppo_kinds:EXPERIMENT",
    "easier": "bootcourse.course.lessons.the_barrier.easier:EXPERIMENT",
    "reachable-entropy": "bootcourse.course.lessons.imitation.reachable_entropy:EXPERIMENT",
    "elsewhere": "bootcourse.research.elsewhere:EXPERIMENT",  # of no lesson, but a function of its own too
    "beyond-search": "bootcourse.research.equal_decisions:SEARCH",
    "beyond": "bootcourse.research.equal_decisions:EXPERIMENT",
    "look-ahead": "bootcourse.research.lookahead:EXPERIMENT",
    "distil": "bootcourse.research.distil:EXPERIMENT",
}


def experiment_named(name: str) -> Experiment | LessonExperiment:
    """The experiment of that name. Raises BootcourseError for an unknown one."""
    check_known("Experiment", name, (*EXPERIMENTS, *LESSON_EXPERIMENTS))
    return EXPERIMENTS[name] if name in EXPERIMENTS else named_function(LESSON_EXPERIMENTS[name])


def chosen(variations: dict, names: dict[str, set[str]], words: str) -> dict:
    """The variations that words such as "ppo_cloned, soft" name, all for "". names: of each variation."""
    wanted, known = {word.strip() for word in words.split(",")} - {""}, sorted(set().union(*names.values()))
    for word in sorted(wanted):
        check_known("Part", word, known)
    return {name: one for name, one in variations.items() if not wanted or wanted & names[name]}


def folder(name: str) -> str:
    """A name as a folder: "γ = 0.9" -> "gamma-0.9"."""
    words = {"γ": "gamma", "β": "beta", "ξ": "xi", "π̃": "stochastic-rule", "μ": "rule", "1/4": "quarter", ",": ""}
    words |= {"η": "eta", "|A|": "A"}  # some file systems refuse a bar
    for letter, word in words.items():
        name = name.replace(letter, word)
    return "-".join(word for word in name.split() if word not in ("=", "x", "at", "m/s"))


def sweep_settings(p: Sequence[float] = P, xi: Sequence[float] = XI, c: Sequence[float] = C) -> list[Settings]:
    """One for each combination that can differ. Without ξ nothing depends on p, so that is run once."""
    wanted = [(a if x else p[0], x, b) for a, x, b in product(p, xi, c)]
    return [settings_for("bootstrapped", rule_p=a, xi_multiplier=x, bonus=b) for a, x, b in dict.fromkeys(wanted)]


def sweep_jobs(seeds: int, episodes: int, tests: int, scenario: Scenario = DEFAULT, together: int = 10) -> list[Job]:
    """The sweep in a few large jobs: its agents differ in p, ξ and c, and still train side by side."""
    agents = [agent for settings in sweep_settings() for agent in with_seeds(settings, seeds)]
    parts = [tuple(agents[i : i + together]) for i in range(0, len(agents), together)]
    return [Job(f"sweep/{i:02}", part, scenario, episodes, tests, runs=False) for i, part in enumerate(parts)]
