"""The study's report and the model card: Markdown with tables, figures and verdicts, made from what is on disk."""

from collections import Counter
from pathlib import Path

import numpy as np

from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.errors import BootcourseError
from bootcourse.files import write_bytes, write_json
from bootcourse.plots.figure import save
from bootcourse.policies import rule_policy
from bootcourse.research import claimed, claims, tables
from bootcourse.research import figures as training_figures
from bootcourse.research.computed import StudyResults
from bootcourse.research.experiment import experiment_named
from bootcourse.research.fidelity import CLOSE, VERDICTS, fidelity, fidelity_table
from bootcourse.research.jobs import HELD_OUT
from bootcourse.research.paper import COLUMNS, INTEGRATED, PRINTED, ROWS, TABLES, arithmetic
from bootcourse.research.results import KINDS, Results, join
from bootcourse.research.studies import STUDIES
from bootcourse.scenario import Scenario
from bootcourse.statistics import ESCAPES, IN_A_ROW, Estimate, mean

ABLATION = "ablation.json"


def rule_results(scenario: Scenario, tests: int) -> Results:
    """The rule controller on the held-out episodes, as one agent without a history."""
    episodes = drive_episodes(rule_policy(scenario), held_out_seeds(HELD_OUT, tests), scenario)
    tested = {name: values[None] for name, values in vars(episodes).items()}
    return Results([{"method": "rule", "seed": 0}], np.array([-1]), tested, {})


def write_report(study: StudyResults, folder: Path) -> Path:
    """Write folder/report.md and its pictures, folder/figures. Raises BootcourseError if nothing was computed."""
    if not study.results:
        raise BootcourseError("No job of this study is finished: run `bootcourse study --out DIR` first.")
    text, findings = [HEAD.format(escapes=100 * ESCAPES, window=IN_A_ROW)], {}
    if study.experiments.get("stress"):
        text += claims.section(claimed.claims(study))
    for name, results in study.results.items():
        rule = rule_results(STUDIES[name].scenario, results.sizes[0])
        everyone = join([Results(results.agents, results.stopped, results.tested, {}), rule])
        findings[name] = fidelity(everyone)
        text += [f"## Study: {name}\n", *study_part(study, name, rule, everyone, folder)]
    text += ["## Fidelity: every number of the paper's two tables\n", FIDELITY.format(close=close()), counted(findings)]
    text += [fidelity_table(findings), "### What each row's own numbers say\n"]
    text += ["\n".join(f"- **{ROWS[method]}.** {arithmetic(method)}" for method in PRINTED) + "\n"]
    for name, computed in study.experiments.items():
        if computed and (section := experiment_named(name).section):
            text += section(study.experiments, folder)
    if "default" in study.results:
        write_json(folder / ABLATION, ablation(study.results["default"]))
    path = folder / "report.md"
    write_bytes(path, "\n".join(text).encode())
    return path


def ablation(results: Results) -> dict:
    """The paper's ablation in numbers, ours beside the paper's, for the page that learns (web/ablation.js)."""
    methods = {}
    for method in (method for method in TABLES[INTEGRATED] if method in results.methods):
        printed, returns = PRINTED[method], results.of(method).scores("returns")
        methods[method] = {
            "ours": {"escaped": results.escapers(method), "agents": len(returns), "returns": round(returns.mean(), 2)},
            "paper": {name: printed[name].mean for name in ("success", "returns")},
        }
    return {"escapes": ESCAPES, "heldOut": held_out_seeds(HELD_OUT, 1)[0], "methods": methods}


def study_part(study: StudyResults, name: str, rule: Results, everyone: Results, folder: Path) -> list[str]:
    """The paper's tables, who escapes, the bound and the figures of one study. everyone: its agents and the rule."""
    results, text, best = study.results[name], [], study.bound.get(STUDIES[name].scenario.name)
    for title, methods in TABLES.items():
        text += [f"### {title}\n", tables.result_table(everyone, methods)]
    others = [method for method in results.methods if not any(method in methods for methods in TABLES.values())]
    if others:
        text += ["### Not in the paper's tables\n", tables.result_table(everyone, others)]
    text += ["### Who escapes\n", tables.escape_table(everyone, results, best)]
    if best is not None:
        text += [f"Best known return of the planner: {tables.bracketed(mean(best))}, {len(best)} episodes.\n"]
    text += staying(study.staying.get(name))
    if "bootstrapped" in results.methods and len(results.methods) > 1:
        text += ["### Probability of improvement\n", tables.markdown(*tables.improvement_rows(everyone))]
    text += ["### Training\n", *pictures(folder, name, results, rule)]
    return text + [stopped(results)]


def pictures(folder: Path, name: str, results: Results, rule: Results) -> list[str]:
    """Draw the figures whose methods are there; returns the Markdown that shows them."""
    there = set(results.methods)
    figures = {
        title: training_figures.training_panels(results, title, rule)
        for title, (_, named) in training_figures.TRAINING_FIGURES.items()
        if there.issuperset(named)
    }
    if {"sac", "bootstrapped"} <= there:
        figures["exploration"] = training_figures.exploration(results)
    for column in ("returns", "success"):
        figures[column] = training_figures.final_scores(results, results.methods, column)
    for title, figure in figures.items():
        save(figure, folder / "figures" / f"{name}-{title}.png")
    return [f"![{figure.alt}](figures/{name}-{title}.png)\n" for title, figure in figures.items()]


def staying(answer: dict | None) -> list[str]:
    """Is staying in the trap optimal at the paper's γ, as far as the planner can tell?"""
    if answer is None:
        return []
    worth = {key: Estimate(*value) for key, value in answer.items() if key != "gamma"}
    names = {
        "idle": "doing nothing",
        "keep_lane": "the best drive found that keeps its lane",
        "rule": "the rule",
        "best": "the best drive found",
        "gain": "what leaving the lane gains",
    }
    rows = [[words, tables.bracketed(worth[key])] for key, words in names.items()]
    pays = "it pays to leave" if worth["gain"].low > 0 else "no drive was found that makes leaving pay"
    ahead = f"{100 * worth['leaves'].value:.0f} % of the best drives found end ahead of trap 1"
    text = f"Discounted with γ = 0.8, from the start: {pays}; {ahead}.\n"
    table = tables.markdown(["driver", "Σ γ^t r_t [95 %]"], rows)
    return ["### Is staying in the trap optimal at γ = 0.8?\n", text, table]


def stopped(results: Results) -> str:
    """Which agents were stopped because their loss was not a number."""
    agents = [(results.agents[i], decision) for i, decision in enumerate(results.stopped) if decision >= 0]
    if not agents:
        return "No agent had to be stopped.\n"
    named = "; ".join(f"{agent['method']}, seed {agent['seed']}, at decision {decision}" for agent, decision in agents)
    return f"Stopped because their loss was not a number, and tested with the weights from before: {named}.\n"


def close() -> str:
    """What counts as close to the paper's number, in words."""
    return ", ".join(f"{COLUMNS[column].split(',')[0]} within {within:g}" for column, within in CLOSE.items())


def counted(findings: dict) -> str:
    """How many numbers of the paper have each verdict, a line for each scenario."""
    lines = []
    for scenario, rows in findings.items():
        count = Counter(row.verdict for row in rows)
        lines.append(f"- {scenario}: " + ", ".join(f"{count[verdict]} {verdict}" for verdict in VERDICTS) + ".")
    return "\n".join(lines) + "\n"


def model_card(results: Results, runs: int) -> str:
    """The card as markdown. results: of the default scenario; runs: the seeds of each method whose weights ship."""
    rows = []
    for method in results.methods:
        agents = results.of(method)
        accidents = [f"{100 * agents.episodes(kind).mean():.1f}" for kind in KINDS]
        escape = tables.k_of_n(agents.scores("success") >= ESCAPES)
        rows.append([method, escape, tables.bracketed(tables.score(results, method, "returns")), *accidents])
    headings = ["method", "agents that escape", *(tables.HEADINGS[name] for name in ("returns", *KINDS))]
    return CARD.format(
        table=tables.markdown(headings, rows),
        tests=results.sizes[0],
        escapes=f"{100 * ESCAPES:g}",
        hidden=" x ".join(map(str, results.agents[0]["hidden"])),
        runs=runs,
    )


HEAD = """# The study

Every agent is the one at the end of its training, never a chosen checkpoint, and drives by its most
probable action. All methods are tested on the same held-out roads. IQM: interquartile mean over
training seeds, with a 95 % interval from resampling seeds. SD: over all episodes of all agents.
Success is to be ahead of trap 1 at the end; a crash after overtaking counts as success, as in the paper.

An agent *escapes* if it succeeds on at least {escapes:g} % of the held-out roads. "Found, kept" says how many agents
found the way out in training, that is, ended ahead in more than half of some {window} episodes in a row, and how many
of these kept it, that is, escape after training.
"""

FIDELITY = """The paper's intervals assume 20 test episodes, the number that its "5 ± 22.36 %" gives away.
An agent of ours scores "so" if it lies in the paper's interval, or close to its value ({close}).
*Reproduced*: at least half of our agents score so. *Partly*: fewer do, or none does but the intervals meet. *Not
reproduced*: neither. The rules were fixed before the study was run.
"""

CARD = """# Model card

**What they are.** The agents in `runs/`: a folder for each of the first {runs} seeds of each method, trained on the
default scenario of this course by `bootcourse study`. Each is an actor and two critics with hidden layers of
{hidden} neurons; it reads 26 numbers and chooses one of 9 actions, once a second. The weights are those at the
end of training: none was selected.

**What they are for.** Lessons: to be driven, replayed, compared and taken apart. **What they are not for:**
anything on a road. They have seen one straight road, one kind of trap and eight other cars that are models
themselves, and some of them crash often.

**How well they drive.** {tests} held-out episodes each, by their most probable action. An agent escapes if at least
{escapes} % of them end ahead of trap 1. Returns are interquartile means over agents with a 95 % interval. Accident
rates are means over the agents' episodes: an interquartile mean would leave out the agents that crash most.

{table}
**Data.** Their own driving in simulation, and for some methods 200 simulated episodes of a rule
controller. No person and no real car is in it.

**Known faults.** Success counts a crash after overtaking, as the paper does: read it beside the accidents.
"""
