"""The course's claims. `claims.py` says what a claim is, and makes the report's part of them.

Every claim is one function below, which reads its numbers from what was computed and names the attempts to refute it:
twice the episodes with other seeds and another implementation (`experiments/stress.py`), other traps, the numbers that
the paper leaves open, somebody else's learner, other roads, half the time step.
"""

import contextlib
import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import scipy

from bootcourse.episodes.evaluate import Episodes, drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.policies import Policy, idle_policy, plan_policy, rule_policy
from bootcourse.research.claims import Claim
from bootcourse.research.computed import StudyResults
from bootcourse.research.experiments.stress import FINER
from bootcourse.research.results import Results
from bootcourse.scenario import CALIBRATED, DEFAULT, N_ACTIONS, Scenario
from bootcourse.statistics import ESCAPES, HAD, IN_A_ROW, LOST, lost

TWICE = "other seeds, another implementation of the learner, twice the episodes"
OTHER_ROADS, HALF = "200 other roads", "half the time step"
ON_OTHER_ROADS = "All rows of the table: on the same 200 other roads."
IN_STEPS = "In each step the car still moves at its old speed: with a shorter step it brakes in less space."
ALOOF = "drivers that do not make way (politeness 0)"
UNGIVING = replace(DEFAULT, traffic=replace(DEFAULT.traffic, politeness=0.0))
Counted = Callable[[Results], np.ndarray]
FOUR = "4 updates, no demonstrations"  # a cell of the experiment with the clocks
HEAD_START = 200 / 201 * math.log(0.9 / (0.1 / (N_ACTIONS - 1)))  # of the rule's action, with p = 0.9 and ξ = 200 α
EASED = "a later start, mid-lane", "accidents cost 1", "mid-lane, and accidents cost 1"  # cells of `easier`
BLOCK, ROADS = 9, 200  # held-out roads that no lesson and no study uses
BLIND = [("keep right", 1), ("keep left", 4), ("keep right", 3), ("accelerate straight", 5)]


def claims(study: StudyResults, lesson: str = "") -> list[Claim]:
    """The claims of a lesson, by default all in the order of the lessons, whose results were computed."""
    made = []
    for claim in CLAIMS.get(lesson, ()) if lesson else (claim for own in CLAIMS.values() for claim in own):
        with contextlib.suppress(KeyError):  # a study or an experiment that was not computed
            made.append(judged(claim, study))
    return made


@cache
def judged(claim: Callable[[StudyResults], Claim], study: StudyResults) -> Claim:
    """A claim, once for each study: the report and the lessons name it."""
    return claim(study)


# Numbers --------------------------------------------------------------------------------------------


def told(results: Results, method: str = "") -> str:
    """ "8 of 10 escape, return 102, accidents 29 %": the return and the accidents beside the success."""
    agents = results.of(method) if method else results
    escape = int((agents.scores("success") >= ESCAPES).sum())
    crash = 100 * agents.scores("accident").mean()
    return f"{escape} of {len(agents)} escape, return {agents.scores('returns').mean():.0f}, accidents {crash:.0f} %"


def share(results: Results, method: str = "") -> float:
    """The share of the agents that escape."""
    agents = results.of(method) if method else results
    return float((agents.scores("success") >= ESCAPES).mean())


def twice(study: StudyResults, cell: str) -> Results:
    """The agents of the stress experiment. Raises KeyError where they were not computed."""
    return study.experiments["stress"][cell]


def different(first: Results | list[Results], second: Results | list[Results], counted: Counted) -> float:
    """Fisher's p for two groups of agents, some of which have what is counted: Results -> (agents,) bool."""
    groups = [each if isinstance(each, list) else [each] for each in (first, second)]
    have = [np.concatenate([counted(agents) for agents in group]) for group in groups]
    return float(scipy.stats.fisher_exact([[int(each.sum()), int((~each).sum())] for each in have]).pvalue)


def escaping(results: Results) -> np.ndarray:
    return results.scores("success") >= ESCAPES


def driven(policy: Callable[[Scenario], Policy], scenario: Scenario = DEFAULT) -> Episodes:
    """The drives of a policy, made for a scenario, on `ROADS` other roads."""
    return drive_episodes(policy(scenario), held_out_seeds(BLOCK, ROADS), scenario)


def rule_with(scenario: Scenario, sight: float, **numbers: float) -> Policy:
    """The rule with another sight (m), and other numbers of `bootcourse.scenario.Rule`."""
    rule = replace(scenario.rule, **numbers)
    return rule_policy(replace(scenario, rule=rule, sight=replace(scenario.sight, distance=sight)))


def safer_at_20_m(name: str, sentence: str, seen: str, usual: dict[str, float], changed: dict[str, float]) -> Claim:
    """That the rule with changed numbers has less than a tenth of the accidents at a sight of 20 m, of `ROADS` drives.

    seen: what is said of the two counts. usual, changed: numbers of `bootcourse.scenario.Rule`.
    """

    def at(scenario: Scenario, block: int = BLOCK) -> tuple[bool, str]:
        policies, roads = (rule_with(scenario, 20.0, **each) for each in (usual, changed)), held_out_seeds(block, ROADS)
        both = [drive_episodes(each, roads, scenario) for each in policies]
        (more, fewer), out = ((each.accident > 0).sum() for each in both), [each.success.sum() for each in both]
        return bool(fewer < more / 10), f"{seen.format(more, fewer)}; {out[0]} and {out[1]} get out"

    evidence = f"{at(DEFAULT, 1)[1]}, of {ROADS} drives"
    stress = {OTHER_ROADS: at(DEFAULT), HALF: at(FINER), ALOOF: at(UNGIVING)}
    return Claim(name, sentence, evidence, stress, also=[ON_OTHER_ROADS, IN_STEPS])


# The claims -----------------------------------------------------------------------------------------


def alone(study: StudyResults) -> Claim:
    ours, faster, more = study.results["default"], study.results["calibrated"], study.experiments["beyond"]
    agents = [more[cell] for cell in ("sac-0", "sac-5")]
    longer = np.concatenate([each.measured["success_200000"] for each in agents]) >= ESCAPES
    earned = np.concatenate([each.measured["returns_200000"] for each in agents]).mean()
    views = study.experiments["sensitivity"]
    other = {cell: views[cell] for cell in ("γ = 0.9", "γ = 0.95", "γ = 0.99")}
    of = sum(len(each.of("sac")) for each in other.values())
    out = sum(int(escaping(each.of("sac")).sum()) for each in other.values())
    return Claim(
        "alone", "Most agents of plain SAC do not escape.", told(ours, "sac"),
        {
            TWICE: (share(twice(study, "sac")) < 0.5, told(twice(study, "sac"))),
            "200,000 decisions, tuned by its own search": (
                longer.mean() < 0.5, f"{longer.sum()} of 10 escape, return {earned:.0f}"
            ),
            "γ = 0.9, 0.95 and 0.99": (out < of / 2, f"{out} of {of} escape"),
            "faster traps (10.9 m/s)": (
                share(faster, "sac") < 0.5,
                f"{told(faster, 'sac')}; at 10 m/s {escaping(ours.of('sac')).sum()} escape",
            ),
        },
    )  # fmt: skip


def eased(study: StudyResults) -> Claim:
    roads = study.experiments["easier"]
    middle, price, both = (roads[road] for road in EASED)

    def only_both(among: Counted, cells: dict[str, str]) -> tuple[bool, str]:
        of = {words: among(roads[cell]) for words, cell in cells.items()}
        one, other, most = (escape.mean() for escape in of.values())
        seen = (f"{words} {escape.sum()} of {len(escape)}" for words, escape in of.items())
        return max(one, other) < 0.5 < most, ", ".join(seen)

    def looking(gamma: float) -> Counted:
        return lambda agents: escaping(agents)[[agent["gamma"] == gamma for agent in agents.agents]]

    words = "mid-lane", "a price of 1", "both"
    as_computed = dict(zip(words, EASED, strict=True))
    return Claim(
        "eased",
        "Where a drive begins mid-lane and an accident costs 1, most agents of plain SAC escape; with one of the two, "
        "most do not.",
        f"mid-lane: {told(middle)}; a price of 1: {told(price)}; both: {told(both)}",
        {
            "other seeds, twice the updates": only_both(
                escaping, {name: f"{road}, twice the updates" for name, road in as_computed.items()}
            ),
            **{f"agents with γ = {gamma} alone": only_both(looking(gamma), as_computed) for gamma in (0.8, 0.95)},
        },
        different(both, middle, escaping),
        [
            "Mid-lane: on the free lane, behind the traps. That takes away the steering, and the wait and risk before.",
            "Tested on 200 roads of their own kind. To escape is not to earn: return and accidents stand beside it.",
        ],
    )  # fmt: skip


def constraint(study: StudyResults) -> Claim:
    ours = study.results["default"]
    return Claim(
        "constraint",
        "With one update for four decisions, most agents with the soft constraint alone escape.",
        told(ours, "soft"),
        {
            TWICE: (share(twice(study, "soft")) > 0.5, told(twice(study, "soft"))),
            "faster traps (10.9 m/s)": (
                share(study.results["calibrated"], "soft") > 0.5, told(study.results["calibrated"], "soft")
            ),
        },
        different(ours.of("soft"), ours.of("sac"), escaping),
        [f"With four updates for each decision {told(study.experiments['clocks'][FOUR], 'soft')}."],
    )  # fmt: skip


def forgotten(study: StudyResults) -> Claim:
    def fewer(results: Results, both: Results) -> tuple[bool, str]:
        seen = f"alone {told(results, 'demos')}; with both aids {told(both, 'bootstrapped')}"
        return share(results, "demos") < share(both, "bootstrapped"), seen

    def counted(results: Results) -> str:
        return f"{share(results, 'demos') * 10:.0f} and {share(results, 'bootstrapped') * 10:.0f} of ten"

    ours, faster, clocks = study.results["default"], study.results["calibrated"], study.experiments["clocks"]
    sooner = clocks["1/4 updates, demonstrations by μ"]
    return Claim(
        "forgotten",
        "With one update for four decisions and drives by the rule itself, fewer agents escape with demonstrations "
        "alone than with the soft constraint as well.",
        fewer(ours, ours)[1],
        {
            TWICE: fewer(twice(study, "demos"), twice(study, "bootstrapped")),
            "1,200 episodes": fewer(sooner, sooner),
            "faster traps (10.9 m/s)": fewer(faster, faster),
        },
        different(ours.of("demos"), ours.of("bootstrapped"), escaping),
        [
            "Withdrawn: that no agent with demonstrations alone escapes. It held for the study's ten, not the others.",
            f"With drives by the stochastic rule {counted(clocks['1/4 updates, demonstrations by π̃'])} escape (alone, "
            f"with both aids); with two updates for each decision as well {counted(study.results['paper'])}.",
        ],
    )  # fmt: skip


def together(study: StudyResults) -> Claim:
    ours, paper, without = study.results["default"], study.results["paper"], "without the bonus"
    unpaid = study.experiments["ablations"]["c = 0"].of("bootstrapped"), twice(study, "bootstrapped, c = 0")
    more = twice(study, "bootstrapped")
    return Claim(
        "together",
        "With both aids, soft constraint and demonstrations, most agents escape, with the bonus or without it (c = 0).",
        f"{told(ours, 'bootstrapped')}; {without} {told(unpaid[0])}",
        {
            TWICE: (min(share(more), share(unpaid[1])) > 0.5, f"{told(more)}; {without} {told(unpaid[1])}"),
            "faster traps (10.9 m/s), with the bonus": (
                share(study.results["calibrated"], "bootstrapped") > 0.5,
                told(study.results["calibrated"], "bootstrapped"),
            ),
            "two updates for each decision, drives by the stochastic rule, with the bonus": (
                share(paper, "bootstrapped") > 0.5, told(paper, "bootstrapped")
            ),
        },
        different(ours.of("bootstrapped"), ours.of("sac"), escaping),
        ["It is not shown that more or fewer escape with the bonus."],
    )  # fmt: skip


def ends(study: StudyResults) -> Claim:
    """Who loses a way out that it had found."""
    ours, changed = study.results["default"], study.experiments["ablations"]
    lasting, sooner = changed["β for ever"], changed["β over 300 episodes"]

    def losing(results: Results, bar: int = LOST) -> np.ndarray:
        return lost(results.of("bootstrapped").curves["success"], bar)

    def against(fading: Results, staying: Results, bar: int = LOST) -> tuple[bool, str]:
        many, few = losing(fading, bar), losing(staying, bar)
        return many.mean() > few.mean(), f"{many.sum()} of {len(many)}, against {few.sum()} of {len(few)}"

    others = twice(study, "bootstrapped"), twice(study, "bootstrapped, β for ever")

    def unpaid(cell: str) -> str:
        return f"{losing(changed[cell]).sum()} of {len(losing(changed[cell]))}"

    return Claim(
        "ends",
        "With both aids and one update for four decisions, more agents lose the way out at least once if the "
        "demonstrations run out by episode 1,000 than if they stay, with their bonus.",
        against(ours, lasting)[1],
        {
            TWICE: against(*others),
            "they run out by episode 300": against(sooner, lasting),
            "lost: 10 of 50 or fewer": against(ours, lasting, 10),
        },
        different(ours, lasting, losing),
        [
            f"Lost: after {HAD} of {IN_A_ROW} training episodes in a row ahead, {LOST} of {IN_A_ROW} or fewer.",
            f"It takes the bonus: with c = 0, {unpaid('c = 0')} lose it if they run out by episode 1,000, "
            f"{unpaid('β for ever, c = 0')} if they stay.",
        ],
    )


def clocks(study: StudyResults) -> Claim:
    cells, ours = study.experiments["clocks"], study.results["default"]
    quarter = {"soft": cells["1/4 updates, no demonstrations"], "demos": cells["1/4 updates, demonstrations by μ"]}
    two = {"soft": cells["2 updates, no demonstrations"], "demos": cells["2 updates, demonstrations by π̃"]}
    many = {method: share(each, method) for method, each in two.items()}
    return Claim(
        "clocks",
        "Which aid alone gets more agents out depends on the updates for each decision, the roads at a time and who "
        "demonstrates, changed together.",
        f"soft against demonstrations: {10 * share(ours, 'soft'):.0f} and {10 * share(ours, 'demos'):.0f} of ten with "
        f"one update for four decisions and the rule (2,000 episodes), {10 * many['soft']:.0f} and "
        f"{10 * many['demos']:.0f} with two for each and the stochastic rule (1,200 episodes)",
        {
            "1,200 episodes, one update for four decisions": (
                share(quarter["soft"], "soft") > share(quarter["demos"], "demos"),
                f"soft {told(quarter['soft'], 'soft')}; demonstrations {told(quarter['demos'], 'demos')}",
            ),
            f"one update for four decisions, {TWICE}": (
                share(twice(study, "soft")) > share(twice(study, "demos")),
                f"soft {told(twice(study, 'soft'))}; demonstrations {told(twice(study, 'demos'))}",
            ),
        },
        different(two["demos"].of("demos"), two["soft"].of("soft"), escaping),
    )  # fmt: skip


def strength(study: StudyResults) -> Claim:
    ours, changed = study.results["default"].of("soft"), study.experiments["ablations"]
    stays = changed["ξ stays at 2"]
    rule = driven(rule_policy).returns.mean()

    def holds(fading: Results, fixed: Results) -> tuple[bool, str]:
        high, low = fading.scores("returns")[escaping(fading)], fixed.scores("returns")
        words = f"escaping agents {high.min():.0f} to {high.max():.0f}, with ξ fixed {low.min():.0f} to {low.max():.0f}"
        return bool(high.min() > 2 * rule and low.max() < 1.1 * rule), words

    def finer(name: str) -> np.ndarray:
        return twice(study, name).measured["finer_returns"]

    out = escaping(twice(study, "soft"))
    step = finer("soft")[out].min(), finer("soft, ξ stays at 2").max()
    return Claim(
        "strength",
        "With a ξ that stays at 2 an agent earns about what the rule earns; with ξ = 200 α those that escape earn more "
        "than twice as much.",
        f"{holds(ours, stays)[1]}; the rule {rule:.0f}",
        {
            TWICE: holds(twice(study, "soft"), twice(study, "soft, ξ stays at 2")),
            HALF: (bool(step[0] > 2 * rule and step[1] < 1.1 * rule), f"at least {step[0]:.0f}, at most {step[1]:.0f}"),
        },
        also=[
            "It is the size of ξ, not that it stays: "
            + "; ".join(f"with a ξ that stays at {xi} {told(changed[f'ξ stays at {xi}'])}" for xi in (0.5, 0.1))
            + f"; of ten others at 0.1 {told(twice(study, 'soft, ξ stays at 0.1'))}.",
            f"The rule's head start stays {HEAD_START:.2f} nats; the temperature 201 α is what fades.",
        ],
    )  # fmt: skip


def floor(study: StudyResults) -> Claim:
    changed = study.experiments["ablations"]
    falls, more = changed["ξ falls to 0.1"], twice(study, "soft, ξ falls to 0.1")
    weak = [changed["ξ stays at 0.1"], twice(study, "soft, ξ stays at 0.1")]
    finer = more.measured["finer_success"] >= ESCAPES
    return Claim(
        "floor",
        "If ξ = 200 α falls to 0.1 and no further, each agent with the soft constraint alone escapes; with 0.1 "
        "throughout fewer do.",
        f"{told(falls)}; with 0.1 throughout {told(weak[0])}",
        {
            TWICE: (share(more) == 1 and share(weak[1]) < 1, f"{told(more)}; with 0.1 throughout {told(weak[1])}"),
            HALF: (bool(finer.all()), f"{finer.sum()} of {len(finer)} escape"),
        },
        different([falls, more], weak, escaping),
        [f"With ξ = 200 α to the end {told(study.results['default'], 'soft')}, and {told(twice(study, 'soft'))}.",
         "The floor also keeps the temperature up: whether that or the pull helps is open."],
    )  # fmt: skip


def second_trap(study: StudyResults) -> Claim:
    more, theirs = study.experiments["beyond"], study.experiments["others"]

    def out(method: str, decisions: int) -> str:
        agents = np.concatenate([more[f"{method}-{i}"].measured[f"success_{decisions}"] for i in (0, 5)])
        earned = np.concatenate([more[f"{method}-{i}"].measured[f"returns_{decisions}"] for i in (0, 5)])
        return f"{(agents >= ESCAPES).sum()} of {len(agents)} escape, return {earned.mean():.0f}"

    def count(method: str, decisions: int) -> int:
        return sum(int((more[f"{method}-{i}"].measured[f"success_{decisions}"] >= ESCAPES).sum()) for i in (0, 5))

    other = theirs["PPO alone"], theirs["PPO after cloning"]
    return Claim(
        "second-trap", "Hardly any agent of PPO alone leaves the trap; after cloning the rule most do.",
        f"other agents than the lesson's, tuned by search, after 200,000 decisions: alone {out('ppo', 200_000)}; after "
        f"cloning {out('ppo_cloned', 200_000)}",
        {
            "four times the decisions": (
                count("ppo", 800_000) == 0 and count("ppo_cloned", 800_000) > 5,
                f"{out('ppo', 800_000)}; {out('ppo_cloned', 800_000)}",
            ),
            "Stable-Baselines3's PPO, tuned by its own search": (
                share(other[0]) == 0 and share(other[1]) > 0.5, f"{told(other[0])}; {told(other[1])}"
            ),
        },
        different(*other, escaping),
    )  # fmt: skip


def margin(study: StudyResults) -> Claim:
    ours = study.results["default"]
    others = {"faster traps (10.9 m/s)": "calibrated", "two updates for each decision": "paper"}
    unpaid = study.experiments["ablations"]["c = 0"]

    def both(results: Results) -> tuple[bool, str]:
        few, many = share(results, "margin"), share(results, "margin_soft")
        return few <= 0.1 and many > 0.5, f"without {told(results, 'margin')}; with {told(results, 'margin_soft')}"

    return Claim(
        "margin",
        "With the large-margin loss most agents escape with the soft constraint, and hardly any without it.",
        both(ours)[1],
        {words: both(study.results[name]) for words, name in others.items()},
        different(ours.of("margin_soft"), ours.of("margin"), escaping),
        [f"No margin, c = 0: {told(unpaid, 'bootstrapped')}; others {told(twice(study, 'bootstrapped, c = 0'))}."],
    )  # fmt: skip


def copies(study: StudyResults) -> Claim:
    ours, rule = study.results["default"], driven(rule_policy).returns.mean()

    def holds(results: Results, most: float) -> bool:
        return share(results, "bc") >= 0.9 and results.of("bc").scores("returns").mean() < most

    faster = drive_episodes(rule_policy(CALIBRATED), held_out_seeds(BLOCK, ROADS), CALIBRATED).returns.mean()
    return Claim(
        "copies", "At least nine of ten of the study's clones escape, and they earn less than the rule itself.",
        f"{told(ours, 'bc')}; the rule {rule:.0f}",
        {
            "faster traps (10.9 m/s)": (
                holds(study.results["calibrated"], faster),
                f"{told(study.results['calibrated'], 'bc')}; the rule {faster:.0f}",
            ),
            "drives by the stochastic rule, twice the updates": (
                holds(study.results["paper"], rule), told(study.results["paper"], "bc")
            ),
        },
    )  # fmt: skip


def sight(study: StudyResults) -> Claim:
    def at(scenario: Scenario) -> tuple[bool, str]:
        far, near = (driven(lambda s, d=d: rule_with(s, sight=d), scenario) for d in (200.0, 30.0))
        crash = 100 * (near.accident > 0).mean()
        words = f"{far.returns.mean():.0f} at 200 m, {near.returns.mean():.0f} at 30 m, accidents {crash:.1f} %"
        return bool(near.returns.mean() > far.returns.mean()), words

    lesson = [
        drive_episodes(rule_with(DEFAULT, sight=distance), held_out_seeds(1, ROADS)).returns.mean()
        for distance in (200.0, 30.0)
    ]
    return Claim(
        "sight",
        "With a sight of 30 m the rule earns more than with 200 m.",
        f"{lesson[0]:.0f} at 200 m, {lesson[1]:.0f} at 30 m",
        {OTHER_ROADS: at(DEFAULT), HALF: at(FINER), ALOOF: at(UNGIVING)},
        also=[ON_OTHER_ROADS],
    )  # fmt: skip


def room(study: StudyResults) -> Claim:
    return safer_at_20_m(
        "room",
        "At a sight of 20 m the rule has accidents with t_safe = 1.5 s, and hardly any with 2 s.",
        "{} accidents with t_safe = 1.5 s, {} with 2 s", {"t_safe": 1.5}, {"t_safe": 2.0},
    )  # fmt: skip


def smaller(study: StudyResults) -> Claim:
    return safer_at_20_m(
        "smaller",
        "At a sight of 20 m the rule has accidents with a floor of 3 m, and hardly any with the smaller one of 0.5 m.",
        "{} accidents with a floor of 3 m, {} with 0.5 m", {"floor": 3.0}, {"floor": 0.5},
    )  # fmt: skip


def discount(study: StudyResults) -> Claim:
    def at(scenario: Scenario, gamma: float, block: int = BLOCK) -> tuple[float, float]:
        roads = held_out_seeds(block, ROADS)
        weights = gamma ** np.arange(scenario.clock.decisions)
        values = []
        for policy in (rule_policy(scenario), idle_policy):
            drives = record(policy, roads, scenario)
            values.append(float(np.mean([weights[: len(d.rewards)] @ d.rewards for d in drives])))
        return values[0], values[1]

    lesson, other, half, far = at(DEFAULT, 0.8, 1), at(DEFAULT, 0.8), at(FINER, 0.8), at(DEFAULT, 0.99, 1)
    return Claim(
        "discount",
        "At the paper's γ = 0.8 the rule's way out is worth less than staying behind, at γ = 0.99 more.",
        f"means of {ROADS} roads: {lesson[0]:.2f} against {lesson[1]:.2f}; at 0.99 {far[0]:.1f} against {far[1]:.1f}",
        {
            OTHER_ROADS: (other[0] < other[1] and far[0] > far[1], f"{other[0]:.2f} against {other[1]:.2f}"),
            HALF: (half[0] < half[1], f"{half[0]:.2f} against {half[1]:.2f}"),
        },
        also=["Quicker ways out without an accident are worth more than staying at γ = 0.8, too."],
    )  # fmt: skip


def blind(study: StudyResults) -> Claim:
    sac = study.results["default"].of("sac").scores("returns").mean()

    def at(scenario: Scenario, block: int = BLOCK) -> tuple[bool, str]:
        drives = drive_episodes(plan_policy(BLIND), held_out_seeds(block, ROADS), scenario)
        success, crash = 100 * drives.success.mean(), 100 * (drives.accident > 0).mean()
        words = f"return {drives.returns.mean():.0f}, ahead on {success:.0f} % of the roads, accidents {crash:.0f} %"
        return bool(drives.returns.mean() > sac and 20 < crash < 30), words

    return Claim(
        "blind",
        "A plan of 13 actions that looks at nothing earns more than plain SAC's mean agent, and crashes on about every "
        "fourth road.",
        f"on {ROADS} of the lesson's roads {at(DEFAULT, 1)[1]}; plain SAC {sac:.0f}",
        {OTHER_ROADS: at(DEFAULT), HALF: at(FINER)},
    )  # fmt: skip


def ahead(study: StudyResults) -> Claim:
    cells = study.experiments["look-ahead"]

    def crashes(cell: str) -> str:
        measured = cells[cell].measured
        return f"{measured['accidents'].sum():.0f} in {measured['roads'].sum():,.0f}"

    before, after, more = "ppo_cloned, alone", "ppo_cloned, rollouts", "ppo_cloned, shield, 10000 roads"
    most = cells[after].measured["accidents"].max()
    return Claim(
        "ahead",
        "With the right model, looking ten seconds ahead before each decision leaves PPO after cloning hardly any "
        "accidents.",
        f"alone {crashes(before)}; looking ahead {crashes(after)}; it earns "
        f"{cells[after].measured['returns'].mean():.0f} instead of {cells[before].measured['returns'].mean():.0f}",
        {
            "the shield instead, on ten times the roads": (
                cells[more].measured["accidents"].sum() < 1e-3 * cells[more].measured["roads"].sum(), crashes(more)
            ),
            "each agent by itself": (
                bool((cells[after].measured["accidents"] <= cells[before].measured["accidents"]).all()),
                f"at most {most:.0f} in 1,000" if most else "none in 1,000",
            ),
        },
    )  # fmt: skip


CLAIMS = {  # by the lesson in which a reader meets them
    "the_trap": (alone, discount, blind),
    "the_barrier": (eased,),
    "the_rule": (sight, room, smaller),
    "demonstrations": (copies,),
    "soft_constraint": (constraint, strength, floor),
    "learning_from_demonstrations": (forgotten, together, margin),
    "found_and_kept": (ends, clocks),
    "the_second_trap": (second_trap,),
    "looking_ahead": (ahead,),
}
