"""The study's report: one Markdown file with its tables, figures and verdicts, made from what is on disk."""

from collections import Counter
from pathlib import Path

import numpy as np

from bootcourse.drivers import rule_driver
from bootcourse.errors import BootcourseError
from bootcourse.record.files import read_arrays, read_json, write_bytes
from bootcourse.scenario import SCENARIOS, Scenario
from bootcourse.study import tables, training_figures
from bootcourse.study.cells import HELD_OUT
from bootcourse.study.drawing import save
from bootcourse.study.evaluate import Estimate, drive_episodes, held_out_seeds, mean
from bootcourse.study.fidelity import CLOSE, VERDICTS, fidelity
from bootcourse.study.paper import COLUMNS, PRINTED, ROWS, TABLES, arithmetic
from bootcourse.study.plan import folder, variations
from bootcourse.study.results import Results, join, load_cells, load_results

FIGURES = {  # name: (function, the methods that it cannot do without)
    "margin-against-bonus": (training_figures.margin_against_bonus, ("margin", "demos")),
    "ablation": (training_figures.ablation, ("sac", "soft", "demos", "bootstrapped")),
    "baselines": (training_figures.baselines, ("bc", "cql", "gail", "sac", "bootstrapped")),
}


def rule_results(scenario: Scenario, tests: int) -> Results:
    """The rule controller on the held-out episodes, as one agent without a history."""
    episodes = drive_episodes(rule_driver(scenario), held_out_seeds(HELD_OUT, tests), scenario)
    tested = {name: values[None] for name, values in vars(episodes).items()}
    return Results([{"method": "rule", "seed": 0}], np.array([-1]), tested, {})


def write_report(root: Path) -> Path:
    """Write root/report.md and its pictures. Raises BootcourseError if no cell is finished."""
    parts = {name: load_cells(root, name) for name in SCENARIOS if list(root.glob(f"cells/{name}/*/results.npz"))}
    if not parts:
        raise BootcourseError(f"No cell is finished in {root}: run `bootcourse study --out {root}`.")
    text = [HEAD, took(root)]
    findings = {}
    for name, results in parts.items():
        rule = rule_results(SCENARIOS[name], results.tested["returns"].shape[1])
        everyone = join([Results(results.agents, results.stopped, results.tested, {}), rule])
        findings[name] = fidelity(everyone)
        text += [f"## Scenario: {name}\n", *scenario_part(root, name, results, rule, everyone)]
    text += ["## Fidelity: every number of the paper's two tables\n", FIDELITY.format(close=close()), counted(findings)]
    text += [tables.fidelity_table(findings), "### What each row's own numbers say\n"]
    text += ["\n".join(f"- **{ROWS[method]}.** {arithmetic(method)}" for method in PRINTED) + "\n"]
    text += sensitivity_part(root)
    path = root / "report.md"
    write_bytes(path, "\n".join(text).encode())
    return path


def scenario_part(root: Path, name: str, results: Results, rule: Results, everyone: Results) -> list[str]:
    text, best = [], bound(root, name, everyone.tested["returns"].shape[1])
    for title, methods in TABLES.items():
        text += [f"### {title}\n", tables.result_table(everyone, methods)]
    others = [method for method in results.methods if not any(method in methods for methods in TABLES.values())]
    if others:
        text += ["### Not in the paper's tables\n", tables.result_table(everyone, others)]
    text += ["### Who escapes\n", tables.escape_table(everyone, best)]
    if best is not None:
        text += [f"Best known return of the planner: {tables.bracketed(mean(best))}, {len(best)} episodes.\n"]
    text += staying(root, name)
    if "bootstrapped" in results.methods and len(results.methods) > 1:
        text += ["### Probability of improvement\n", tables.improvement_table(everyone)]
    text += ["### Training\n", *pictures(root, name, results, rule)]
    return text + [stopped(results)]


def pictures(root: Path, name: str, results: Results, rule: Results) -> list[str]:
    """Draw what can be drawn with these methods; Markdown that shows it."""
    figures = {}
    for title, (draw, needed) in FIGURES.items():
        if set(needed) <= set(results.methods):
            figures[title] = draw(results, rule)
    if {"sac", "bootstrapped"} <= set(results.methods):
        figures["exploration"] = training_figures.exploration(results)
    figures["returns"] = training_figures.final_scores(results, results.methods, "returns")
    figures["success"] = training_figures.final_scores(results, results.methods, "success")
    for title, figure in figures.items():
        save(figure, root / "figures" / f"{name}-{title}.png")
    return [f"![{figure.alt}](figures/{name}-{title}.png)\n" for title, figure in figures.items()]


def bound(root: Path, name: str, tests: int) -> np.ndarray | None:
    """The best known return of each held-out episode, (tests,), if the planner has looked at them all."""
    cells = [read_arrays(path) for path in root.glob(f"cells/bound-{name}/*/results.npz")]
    found = {int(cell["first"]) + i: value for cell in cells for i, value in enumerate(cell["returns"])}
    return np.array([found[i] for i in range(tests)]) if set(range(tests)) <= set(found) else None


def staying(root: Path, name: str) -> list[str]:
    """Is staying in the trap optimal at the paper's γ, as far as the planner can tell?"""
    path = root / f"cells/staying-{name}/gamma-0.8/staying.json"
    if not path.exists():
        return []
    worth = {key: Estimate(*value) for key, value in read_json(path).items() if key != "gamma"}
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
    agents = [(results.agents[i], decision) for i, decision in enumerate(results.stopped) if decision >= 0]
    if not agents:
        return "No agent had to be stopped.\n"
    sentences = [f"{agent['method']}, seed {agent['seed']}, at decision {decision}" for agent, decision in agents]
    return (
        "Stopped because their loss was not a number, and tested with the weights from before: "
        + "; ".join(sentences)
        + ".\n"
    )


def sensitivity_part(root: Path) -> list[str]:
    found = {}
    for name in variations():
        path = root / "cells" / "sensitivity" / folder(name) / "results.npz"
        if path.exists():
            found[name] = load_results(path)
    if not found:
        return []
    seeds = len(next(iter(found.values())).of("sac"))
    text = ["## Sensitivity\n", f"{seeds} seeds each: mean (lowest to highest seed). Too few for intervals.\n"]
    return text + [tables.sensitivity_table(found, measure) for measure in ("success", "returns", "collision")]


def close() -> str:
    return ", ".join(f"{COLUMNS[column].split(',')[0]} within {within:g}" for column, within in CLOSE.items())


def counted(findings: dict) -> str:
    lines = []
    for scenario, its in findings.items():
        count = Counter(finding.verdict for finding in its)
        lines.append(f"- {scenario}: " + ", ".join(f"{count[verdict]} {verdict}" for verdict in VERDICTS) + ".")
    return "\n".join(lines) + "\n"


def took(root: Path) -> str:
    cells = [read_json(path) for path in sorted(root.glob("cells/*/*/cell.json"))]
    seconds = sum(cell["provenance"]["seconds"] for cell in cells)
    made = cells[0]["provenance"]
    versions = ", ".join(f"{name} {made[name]}" for name in ("bootcourse", "python", "torch", "numpy", "numba"))
    return (
        f"{len(cells)} cells (a sweep in this folder included) took {seconds / 60:.0f} core-minutes, with {versions}.\n"
    )


HEAD = """# The study

Every agent is the one at the end of its training, never a chosen checkpoint, and drives by its most
probable action. All methods are tested on the same held-out roads. IQM: interquartile mean over
training seeds, with a 95 % interval from resampling seeds. SD: over all episodes of all agents.
Success is to be ahead of trap 1 at the end; a crash after overtaking counts as success, as in the paper.
"""

FIDELITY = """The paper's intervals assume 20 test episodes, the number that its "5 ± 22.36 %" gives away.
An agent of ours scores "so" if it lies in the paper's interval, or close to its value ({close}).
*Reproduced*: at least half of our agents score so. *Partly*: fewer do, or none does but the intervals meet. *Not
reproduced*: neither. The rules were fixed before the study was run.
"""
