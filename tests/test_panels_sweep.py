"""The sweep's panel, on a small invented sweep."""

import numpy as np
import pytest

from bootcourse.learn.settings import Settings
from bootcourse.learn.training import Training
from bootcourse.panels.sweep import sweep_panel
from bootcourse.panels.sweep_view import choices, rerun
from bootcourse.research.plan import sweep_settings
from bootcourse.research.results import Results, save_results
from bootcourse.research.sweep import nearest_setting, settings_run
from tests.panels import from_page, raise_in_callbacks, words  # noqa: F401

pytestmark = pytest.mark.usefixtures("raise_in_callbacks")


def invented(which=lambda s: True) -> Results:
    """Two agents of each setting; their success names it: p / 2 + ξ / 10000 + c / 100."""
    settings = [s for s in sweep_settings() if which(s)]
    agents = [
        {"method": "bootstrapped", "seed": seed, "rule_p": s.rule_p, "xi_multiplier": s.xi_multiplier, "bonus": s.bonus}
        for s in settings
        for seed in range(2)
    ]
    wanted = np.array([a["rule_p"] / 2 + a["xi_multiplier"] / 1e4 + a["bonus"] / 100 for a in agents])
    success = (np.arange(200) < (200 * wanted[:, None])).astype(np.int8)
    tested = {"success": success, "returns": 10.0 * success, "accident": (1 - success).astype(np.int8)}
    tested |= dict.fromkeys(("speed", "distance"), np.zeros(success.shape))
    curves = {"success": np.tile(wanted[:, None], 60).astype(np.float16), "return": np.ones((len(agents), 60))}
    return Results(agents, np.full(len(agents), -1), tested, curves)


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("sweep") / "sweep.npz"
    save_results(invented(), path, {})
    return path


@pytest.fixture
def panel(file):
    return sweep_panel(file)


def sliders(panel):
    return {"p": panel.p, "xi_multiplier": panel.xi, "c": panel.c}


def test_the_sliders_hold_the_settings_that_were_run_and_no_others(panel):
    assert choices(panel.sweep) == ([0.5, 0.9, 0.99], [0, 20, 200, 2000], [0, 2, 5])
    for control, values in zip(sliders(panel).values(), choices(panel.sweep), strict=True):
        assert [value for _, value in control.slider.options] == values


def test_every_slider_at_both_its_ends_shows_what_happened_there(panel):
    for name, control in sliders(panel).items():
        for index in (0, len(control.slider.options) - 1):
            from_page(control.slider, index=index)
            asked = {each: other.value for each, other in sliders(panel).items()}
            happened = nearest_setting(panel.sweep, **asked)
            assert getattr(panel.happened, name) == control.slider.value == control.field.value
            assert str(happened) in words(panel) and rerun(happened).splitlines()[-1] in panel.code.value


def test_a_number_that_was_not_run_snaps_to_the_nearest_and_says_so(panel):
    for control, typed, found in ((panel.p, 0.8, 0.9), (panel.xi, 90.0, 200), (panel.xi, 1e9, 2000), (panel.c, 4, 5)):
        from_page(control.field, value=typed)
        assert control.value == found == control.field.value and "nearest that was" in words(control)
    from_page(panel.c.field, value=2.0)
    assert panel.c.value == 2 and "nearest" not in words(panel.c)


@pytest.mark.parametrize("nonsense", [float("nan"), float("inf"), -1.0])
def test_nonsense_is_refused_in_a_sentence_and_changes_nothing(panel, nonsense):
    before = str(panel.happened)
    for control in sliders(panel).values():
        from_page(control.field, value=nonsense)
        assert "give" in words(control) or "outside" in words(control)
    assert str(panel.happened) == before


def test_without_the_constraint_p_does_not_matter_and_has_one_cell(panel):
    from_page(panel.xi.slider, index=0)
    shown = panel.chart.value
    from_page(panel.p.slider, index=2)
    assert panel.chart.value == shown and "p does not matter" in words(panel) and shown.count("any p") == 3


def test_every_cell_of_the_heat_maps_has_its_value_and_the_chosen_one_a_frame(panel):
    from_page(panel.c.slider, index=0)
    for p, xi, c in settings_run(panel.sweep):
        if c == 0:
            value = 100 * nearest_setting(panel.sweep, p, xi, c).mean("success").value
            assert f">{round(value, 1):.6g}</text>" in panel.chart.value
    assert panel.chart.value.count('stroke-width="3"') == 3 and "c = 0" in panel.chart.value


def test_a_sweep_with_holes_names_them_and_says_that_the_nearest_is_shown(tmp_path):
    save_results(invented(lambda s: (s.rule_p, s.xi_multiplier) != (0.99, 200.0)), tmp_path / "some.npz", {})
    panel = sweep_panel(tmp_path / "some.npz")
    panel.p.slider.value, panel.xi.slider.value = 0.99, 200.0
    assert "This setting was not run" in words(panel) and not panel.happened.exact
    assert ">not run<" in panel.chart.value


def test_the_python_that_it_offers_trains_the_very_settings(panel, monkeypatch):
    from_page(panel.p.slider, index=0)
    asked = []
    monkeypatch.setattr(Training, "__init__", lambda self, settings, episodes: asked.append((settings, episodes)))
    monkeypatch.setattr(Training, "run", lambda self: None)
    exec(rerun(panel.happened), {})
    settings, episodes = asked[0]
    happened = panel.happened
    assert settings[0] == Settings(rule_p=happened.p, xi_multiplier=happened.xi_multiplier, bonus=happened.c)
    assert [each.seed for each in settings] == [0, 1] and episodes == 60


def test_a_file_that_is_missing_is_one_sentence(tmp_path):
    panel = sweep_panel(tmp_path / "none.npz")
    assert "is not there" in words(panel) and panel.happened is None and panel.picture().alt


def test_a_file_that_is_damaged_is_one_sentence(tmp_path, file):
    (tmp_path / "cut.npz").write_bytes(file.read_bytes()[:500])
    np.savez(tmp_path / "other.npz", numbers=np.arange(3))
    assert "damaged or cut short" in words(sweep_panel(tmp_path / "cut.npz"))
    assert "does not hold a study's results" in words(sweep_panel(tmp_path / "other.npz")).replace("&#39;", "'")


def test_a_reader_without_a_kernel_sees_the_maps(panel):
    bundle = panel._repr_mimebundle_()
    assert "data:image/svg+xml" in bundle["text/html"] and bundle["text/plain"] == str(panel.happened)


def test_the_drawing_keeps_its_size(panel):
    sizes = set()
    for index in range(4):
        from_page(panel.xi.slider, index=index)
        sizes.add(panel.chart.value[: panel.chart.value.index("role")])
    assert len(sizes) == 1 and "nan" not in panel.chart.value
