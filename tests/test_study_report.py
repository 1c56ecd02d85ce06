"""The paper's numbers, the verdicts on them, the tables, the figures and the report."""

import re

import numpy as np
import pytest

from bootcourse.files import write_json
from bootcourse.learn.settings import settings_for
from bootcourse.research import tables
from bootcourse.research.computed import in_study
from bootcourse.research.fidelity import fidelity, verdict_on
from bootcourse.research.paper import COLUMNS, PRINTED, TABLES, arithmetic, earned_at, paper_interval, possible
from bootcourse.research.report import rule_results, write_report
from bootcourse.research.results import Results, agent_entries, save_results
from bootcourse.scenario import SCENARIOS
from bootcourse.statistics import Estimate

METHODS = ("bc", "cql", "gail", "sac", "soft", "demos", "bootstrapped", "margin", "margin_soft")


def invented(methods=METHODS, seeds: int = 10, tests: int = 40, episodes: int = 90) -> Results:
    """Agents that were never trained: scores and curves drawn at random."""
    rng = np.random.default_rng(0)
    agents = agent_entries([settings_for(method, seed=seed) for method in methods for seed in range(seeds)])
    shape, n = (len(agents), tests), len(agents)
    tested = {
        "success": (rng.random(shape) < rng.random((n, 1))).astype(np.int8),
        "returns": rng.normal(30, 5, shape).astype(np.float32),
        "speed": rng.normal(11, 0.5, shape).astype(np.float32),
        "distance": rng.normal(1600, 50, shape).astype(np.float32),
        "accident": rng.integers(0, 4, shape).astype(np.int8),
    }
    names = {"success": 1, "return": 30, "speed": 11, "distance": 1600, "entropy": 2}
    curves = {name: (rng.random((n, episodes)) * top).astype(np.float32) for name, top in names.items()}
    return Results(agents, np.full(n, -1), tested, curves)


def scoring(method: str, column: str, scores) -> Results:
    """Agents of a method whose score in a column is given."""
    scores = np.asarray(scores, dtype=np.float64)
    empty = invented((method,), len(scores), 20)
    return Results(empty.agents, empty.stopped, empty.tested | {column: np.repeat(scores[:, None], 20, axis=1)}, {})


def test_every_number_of_both_tables_is_there_and_one_collision_in_twenty_has_the_deviation_of_gail_s_row():
    methods = [method for table in TABLES.values() for method in table]
    assert len(methods) == 9 and set(methods) == set(PRINTED)
    assert PRINTED["demos"]["collision"] == (5, 29.69) and PRINTED["rule"]["distance"] == (1727.01, 8.3)
    assert np.std([1] + [0] * 19, ddof=1) * 100 == pytest.approx(22.36, abs=0.005)
    assert possible("gail", "collision") and not possible("demos", "collision")
    assert paper_interval("soft", "success").high == pytest.approx(16.84, abs=0.01)


def test_the_arithmetic_of_a_row_is_the_road_s_own_reward():
    assert earned_at(10.0) == pytest.approx(23.4375)
    assert earned_at(11.51) == pytest.approx(150 * (0.025 * 11.51 - 0.09375))
    assert "133.5 s" in arithmetic("sac") and "ended early" in arithmetic("sac")
    assert "cannot have a deviation of 29.69" in arithmetic("demos")


VERDICT = {
    "all agents score so": ([26.8, 26.7, 26.9, 26.75], "reproduced"),
    "one in four does": ([26.8, 40.0, 41.0, 42.0], "partly"),
    "none does, but their mean cannot be told apart": ([20.0, 33.0, 20.5, 33.5], "partly"),
    "none does": ([40.0, 41.0, 42.0, 43.0], "not reproduced"),
}


def test_what_cannot_be_compared_is_said_and_the_rule_s_interval_is_over_episodes():
    findings = {(row.method, row.column): row for row in fidelity(invented(("demos",)))}
    assert len(findings) == 35 and findings["demos", "collision"].verdict == "cannot be compared"
    assert findings["cql", "speed"].reason == "This study has not run this method."
    finding = verdict_on(rule_results(SCENARIOS["default"], 20), "rule", "success")
    assert finding.verdict == "reproduced" and finding.ours.low == pytest.approx(83.16, abs=0.01)


@pytest.mark.parametrize("case", VERDICT)
def test_the_verdict_follows_its_rule_when(case):
    scores, verdict = VERDICT[case]
    finding = verdict_on(scoring("soft", "returns", scores), "soft", "returns")
    assert finding.verdict == verdict and finding.ours.value == pytest.approx(np.mean(scores))


def report_of(results: Results, root) -> None:
    folder = root / "jobs/default/all"
    save_results(results, folder / "results.npz", {})
    versions = dict.fromkeys(("bootcourse", "python", "torch", "numpy", "numba"), "1") | {"seconds": 60}
    write_json(folder / "job.json", {"asked": {}, "sha256": {}, "provenance": versions})
    write_report(in_study(root), root)


def test_the_report_holds_every_table_and_figure_and_names_the_agents_that_were_stopped(tmp_path, unrendered):
    results = invented(seeds=4)
    results.curves["return"][1, 50:] = np.nan
    results.stopped[1] = 1234
    report_of(results, tmp_path)
    text = (tmp_path / "report.md").read_text()
    shown = re.findall(r"\]\((figures/[^)]+)\)", text)
    assert (
        "bc, seed 1, at decision 1234" in text and len(shown) == 6 and all((tmp_path / name).exists() for name in shown)
    )
    assert all(len(words) > 100 and "nan" not in words for words in re.findall(r"!\[([^]]+)\]\(figures", text))
    for heading in (*TABLES, "Fidelity", "Probability of improvement", "Who escapes", "found, kept"):
        assert heading in text
    assert "| 21.32 ± 7.39 | 10.5 ± 1.28 | 1402.16 ± 182.87 |" in text and "IQM over 4 agents" in text
    assert text.count("**reproduced**") + text.count("**partly**") + text.count("**not reproduced**") == 34
    for column in COLUMNS.values():
        assert f"| {column} |" in text


@pytest.mark.parametrize(
    ("estimate", "words"),
    [((62, 39.12, 83.4), "62 [39, 83]"), ((127.31, 125.04, 128.92), "127.3 [125.0, 128.9]"),
     ((1.2345, 1.2, 1.27), "1.23 [1.20, 1.27]"), ((44.875, np.nan, np.nan), "44.88")],
)  # fmt: skip
def test_an_interval_is_printed_with_the_decimals_that_its_length_leaves_meaningful(estimate, words):
    assert tables.bracketed(Estimate(*estimate)) == words
