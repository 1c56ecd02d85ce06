"""The sweep over p, ξ and c: what happened at the nearest setting that was run, and the panel that shows it."""

import numpy as np
import pytest
from typer.testing import CliRunner

from bootcourse import cli
from bootcourse.errors import BootcourseError
from bootcourse.learn.settings import Settings
from bootcourse.learn.training import Training
from bootcourse.panels import sweep_panel
from bootcourse.research.plan import sweep_jobs, sweep_settings
from bootcourse.research.results import Results, load_results, save_results
from bootcourse.research.sweep import nearest_setting, settings_run, sweep_table
from bootcourse.research.sweep_panel import choices, rerun
from tests.panels import from_page, raise_in_callbacks, words  # noqa: F401

pytestmark = pytest.mark.usefixtures("raise_in_callbacks")


def invented(which=lambda s: True) -> Results:
    """Two agents of each setting; their success names it: p / 2 + ξ / 10000 + c / 100."""
    settings = [s for s in sweep_settings() if which(s)]
    named = [{"rule_p": s.rule_p, "xi_multiplier": s.xi_multiplier, "bonus": s.bonus} for s in settings]
    agents = [{"method": "bootstrapped", "teacher": "rule", "seed": i} | one for one in named for i in range(2)]
    wanted = np.array([a["rule_p"] / 2 + a["xi_multiplier"] / 1e4 + a["bonus"] / 100 for a in agents])
    success = (np.arange(200) < (200 * wanted[:, None])).astype(np.int8)
    tested = {"success": success, "returns": 10.0 * success, "accident": (1 - success).astype(np.int8)}
    tested |= dict.fromkeys(("speed", "distance"), np.zeros(success.shape))
    curves = {"success": np.tile(wanted[:, None], 60).astype(np.float16), "return": np.ones((len(agents), 60))}
    return Results(agents, np.full(len(agents), -1), tested, curves)


@pytest.fixture(scope="module")
def sweep() -> Results:
    return invented()


NEAR = {
    "a setting that was run": ((0.99, 20, 5), (0.99, 20, 5)),
    "a little less p": ((0.85, 200, 2), (0.9, 200, 2)),
    "ξ counts by its logarithm": ((0.9, 80, 2), (0.9, 200, 2)),
    "a p near 1 counts by its odds": ((0.98, 200, 2), (0.99, 200, 2)),
    "more of everything than was run": ((0.9999, 1e6, 50), (0.99, 2000, 5)),
    "c between two": ((0.9, 200, 0.9), (0.9, 200, 0)),
}


@pytest.mark.parametrize("case", NEAR)
def test_the_nearest_setting_is_found_with_its_seeds(sweep, case):
    asked, nearest = NEAR[case]
    happened = nearest_setting(sweep, *asked)
    assert (happened.p, happened.xi_multiplier, happened.c) == nearest and len(happened.results) == 2
    assert happened.exact == (asked == nearest)


def test_the_answer_reads_as_a_sentence_and_a_value_that_cannot_be_is_refused(sweep):
    assert str(nearest_setting(sweep)) == (
        "p = 0.9, ξ = 200 α, c = 2, 2 seeds: success 50 % [50, 50], return 5.0 [5.0, 5.0], accidents 50 %"
    )
    happened = nearest_setting(sweep, 0.3, 0, 2)  # without the constraint p does not matter
    assert happened.exact and (happened.xi_multiplier, happened.c) == (0, 2) and "p does not matter" in str(happened)
    for wrong in ({"p": 1.0}, {"p": 0.05}, {"xi_multiplier": -1}, {"c": float("nan")}):
        with pytest.raises(BootcourseError, match="p =|give a finite number"):
            nearest_setting(sweep, **wrong)


def test_every_combination_is_run_once_and_has_a_row_in_the_table(sweep):
    settings = [s for each in sweep_jobs(4, 10, 5) for s in each.settings]
    places = {(s.rule_p if s.xi_multiplier else 0, s.xi_multiplier, s.bonus, s.seed) for s in settings}
    assert len(places) == len(settings) == 4 * (3 * 3 * 3 + 3) == 4 * len(settings_run(sweep))
    assert sweep_table(sweep.pick(range(8))).count("\n") == 2 + 4


def test_a_sweep_is_computed_into_one_small_file(tmp_path, monkeypatch):
    monkeypatch.setattr("bootcourse.research.plan.sweep_settings", lambda: sweep_settings((0.9,), (0.0, 200.0), (2.0,)))
    options = {"--out": tmp_path, "--seeds": 2, "--episodes": 3, "--tests": 4, "--workers": 1}
    arguments = [str(word) for pair in options.items() for word in pair]
    assert CliRunner().invoke(cli.app, ["study", "sweep", *arguments]).exit_code == 0
    results = load_results(tmp_path / "sweep.npz")
    assert len(results) == 4 and nearest_setting(results, 0.5, 2000, 0).xi_multiplier == 200
    assert (tmp_path / "sweep.npz").stat().st_size < 20_000


# The panel -----------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def file(sweep, tmp_path_factory):
    path = tmp_path_factory.mktemp("sweep") / "sweep.npz"
    save_results(sweep, path, {})
    return path


def test_each_slider_holds_the_values_that_were_run_and_shows_what_happened_there(file):
    panel = sweep_panel(file)
    for control, values in zip((panel.p, panel.xi, panel.c), choices(panel.sweep), strict=True):
        assert [value for _, value in control.options] == values
        for index in (0, len(values) - 1):
            from_page(control, index=index)
            happened = nearest_setting(panel.sweep, panel.p.value, panel.xi.value, panel.c.value)
            assert str(panel.happened) == str(happened) and str(happened) in words(panel)
            assert rerun(happened).splitlines()[-1] in panel.code.value
    from_page(panel.xi, index=0)
    assert "p does not matter" in words(panel) and panel.chart.value.count("any p") == 3
    bundle = panel._repr_mimebundle_()
    assert "data:image/svg+xml" in bundle["text/html"] and bundle["text/plain"] == str(panel.happened)


def test_every_cell_of_the_heat_maps_has_its_value_and_the_chosen_one_a_frame(file):
    panel = sweep_panel(file)
    from_page(panel.c, index=0)
    for p, xi, c in settings_run(panel.sweep):
        if c == 0:
            value = 100 * nearest_setting(panel.sweep, p, xi, c).mean("success").value
            assert f">{round(value, 1):.6g}</text>" in panel.chart.value
    assert panel.chart.value.count('stroke-width="3"') == 3 and "nan" not in panel.chart.value


def test_a_sweep_with_holes_says_that_the_nearest_is_shown(tmp_path):
    save_results(invented(lambda s: (s.rule_p, s.xi_multiplier) != (0.99, 200.0)), tmp_path / "some.npz", {})
    panel = sweep_panel(tmp_path / "some.npz")
    panel.p.value, panel.xi.value = 0.99, 200.0
    assert "This setting was not run" in words(panel) and not panel.happened.exact
    assert ">not run<" in panel.chart.value


def test_the_python_that_it_offers_trains_the_very_settings(sweep, monkeypatch):
    happened, asked = nearest_setting(sweep, 0.5, 20, 0), []
    monkeypatch.setattr(Training, "__init__", lambda self, settings, episodes: asked.append((settings, episodes)))
    monkeypatch.setattr(Training, "run", lambda self: None)
    exec(rerun(happened), {})
    settings, episodes = asked[0]
    assert settings[0] == Settings(rule_p=0.5, xi_multiplier=20.0, bonus=0.0) and episodes == 60
    assert [each.seed for each in settings] == [0, 1]


def test_a_file_that_is_missing_or_damaged_is_one_sentence(tmp_path, file):
    (tmp_path / "cut.npz").write_bytes(file.read_bytes()[:500])
    np.savez(tmp_path / "other.npz", numbers=np.arange(3))
    for name, sentence in (
        ("none", "is not there"), ("cut", "damaged or cut short"), ("other", "does not hold a study's results"),
    ):  # fmt: skip
        panel = sweep_panel(tmp_path / f"{name}.npz")
        assert sentence in words(panel).replace("&#39;", "'") and panel.happened is None and panel.svg.alt
