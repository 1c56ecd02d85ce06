"""The sweep over p, ξ and c: what happened at the nearest setting that was run?"""

import numpy as np
import pytest
from typer.testing import CliRunner

from bootcourse import cli
from bootcourse.errors import BootcourseError
from bootcourse.research.plan import sweep_settings
from bootcourse.research.results import Results, load_results
from bootcourse.research.sweep import nearest_setting, settings_run, sweep_table


@pytest.fixture(scope="module")
def sweep() -> Results:
    """Invented results: each agent's return names its setting."""
    agents = [
        {"method": "bootstrapped", "seed": seed, "rule_p": s.rule_p, "xi_multiplier": s.xi_multiplier, "bonus": s.bonus}
        for s in sweep_settings()
        for seed in range(4)
    ]
    returns = np.array(
        [100 * a["rule_p"] * (a["xi_multiplier"] > 0) + a["xi_multiplier"] + a["bonus"] / 10 for a in agents]
    )
    tested = {"returns": np.repeat(returns[:, None], 5, axis=1), "accident": np.zeros((len(agents), 5), np.int8)}
    tested["success"] = np.ones((len(agents), 5), np.int8)
    return Results(agents, np.full(len(agents), -1), tested, {"return": np.zeros((len(agents), 3))})


@pytest.mark.parametrize("p", [0.5, 0.9, 0.99])
@pytest.mark.parametrize("xi", [20, 200, 2000])
def test_a_setting_that_was_run_finds_itself_with_its_four_seeds(sweep, p, xi):
    happened = nearest_setting(sweep, p, xi, 5)
    assert (
        (happened.p, happened.xi_multiplier, happened.c) == (p, xi, 5) and happened.exact and len(happened.results) == 4
    )
    assert happened.mean("returns").value == pytest.approx(100 * p + xi + 0.5)


NEAR = {
    "a little less p": ((0.85, 200, 2), (0.9, 200, 2)),
    "ξ counts by its logarithm": ((0.9, 80, 2), (0.9, 200, 2)),
    "a p near 1 counts by its odds": ((0.98, 200, 2), (0.99, 200, 2)),
    "more of everything than was run": ((0.9999, 1e6, 50), (0.99, 2000, 5)),
    "c between two": ((0.9, 200, 0.9), (0.9, 200, 0)),
}


@pytest.mark.parametrize("case", NEAR)
def test_the_nearest_setting_is_found_when(sweep, case):
    asked, found = NEAR[case]
    happened = nearest_setting(sweep, *asked)
    assert (happened.p, happened.xi_multiplier, happened.c) == found and not happened.exact


def test_without_the_constraint_p_does_not_matter(sweep):
    for p in (0.3, 0.9, 0.99):
        happened = nearest_setting(sweep, p, 0, 2)
        assert happened.exact and happened.xi_multiplier == 0 and happened.c == 2
    assert "p does not matter" in str(happened)


def test_the_answer_reads_as_a_sentence(sweep):
    assert str(nearest_setting(sweep)) == (
        "p = 0.9, ξ = 200 α, c = 2, 4 seeds: success 100 % [100, 100], return 290.2 [290.2, 290.2], accidents 0 %"
    )


@pytest.mark.parametrize("wrong", [{"p": 1.0}, {"p": 0.05}, {"xi_multiplier": -1}, {"c": float("nan")}])
def test_a_value_that_cannot_be_is_refused(sweep, wrong):
    with pytest.raises(BootcourseError, match="p =|give a finite number"):
        nearest_setting(sweep, **wrong)


def test_every_setting_has_a_row_in_the_table(sweep):
    assert len(settings_run(sweep)) == 30 and sweep_table(sweep.pick(range(8))).count("\n") == 4


def test_a_sweep_is_computed_into_one_small_file(tmp_path, monkeypatch):
    monkeypatch.setattr("bootcourse.research.plan.sweep_settings", lambda: sweep_settings((0.9,), (0.0, 200.0), (2.0,)))
    options = {"--out": tmp_path, "--seeds": 2, "--episodes": 3, "--tests": 4, "--workers": 1}
    arguments = [str(word) for pair in options.items() for word in pair]
    assert CliRunner().invoke(cli.app, ["sweep", *arguments]).exit_code == 0
    found = load_results(tmp_path / "sweep.npz")
    assert len(found) == 4 and nearest_setting(found, 0.5, 2000, 0).xi_multiplier == 200
    assert (tmp_path / "sweep.npz").stat().st_size < 20_000
