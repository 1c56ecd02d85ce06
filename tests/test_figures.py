"""The figures: what is drawn is what was driven, everything has words, and bad input gets a sentence."""

import io
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from bootcourse.course.lessons.the_barrier import easier
from bootcourse.course.lessons.the_barrier.figures import escapes
from bootcourse.course.lessons.values.diagrams import who_leaves
from bootcourse.course.shipped import shipped_experiment
from bootcourse.episodes.rollout import series
from bootcourse.episodes.words import cars_at, overtaken
from bootcourse.errors import BootcourseError
from bootcourse.methods import style
from bootcourse.plots import animation
from bootcourse.plots.figure import Picture, png, save, styles, wrapped
from bootcourse.plots.road import draw_cars
from bootcourse.plots.top_view import top_view_over_time
from bootcourse.plots.traces import traces
from bootcourse.plots.training_curves import training_curves
from bootcourse.road.state import EGO, HEADING, LANE, SPEED, TRAP_1, TRAP_2, X, Y
from bootcourse.scenario import DEFAULT
from bootcourse.storage.assets import FOLDER


def curves(agents: int = 4, episodes: int = 120, missing: int = 0) -> dict[str, np.ndarray]:
    """Invented curves; the last agent misses its last `missing` episodes."""
    rng = np.random.default_rng(0)
    values_of = {
        "success": (rng.random((agents, episodes)) < 0.5) * 1.0,
        "return": rng.normal(20, 3, (agents, episodes)),
    }
    for values in values_of.values():
        values[-1, episodes - missing :] = np.nan
    return values_of


def cars_drawn(ax) -> dict[str, tuple[float, float, float]]:
    """x, y and heading of each car body in an axes, in its data coordinates."""
    places = {}
    for patch in ax.patches:
        if patch.get_gid():
            corners = patch.get_xy()[:-1]
            back, front = (half.mean(axis=0) for half in (corners[4:12], np.r_[corners[:4], corners[12:]]))
            places[patch.get_gid()] = (*corners.mean(axis=0), np.arctan2(*(front - back)[::-1]))
    return places


def overlaps(figure) -> list[tuple[str, str]]:
    """Pairs of texts that lie on each other, in a drawn figure."""
    figure.canvas.draw()
    texts = [text for ax in figure.axes for text in [*ax.texts, ax.xaxis.label, ax.yaxis.label]]
    texts = [text for text in [*texts, *figure.texts] if text.get_text() and text.get_visible()]
    boxes = [text.get_window_extent() for text in texts]
    return [
        (texts[i].get_text(), texts[j].get_text())
        for i in range(len(texts))
        for j in range(i)
        if boxes[i].overlaps(boxes[j])
    ]


@pytest.mark.parametrize("time", [0.0, 5.5, 9.0, 9.25])
def test_the_cars_are_drawn_where_they_were_driven(escape, time):
    drawn = cars_drawn(top_view_over_time(escape, [time]).axes[0])
    cars, step = cars_at(escape, time), int(time / DEFAULT.clock.dt)
    if time == step * DEFAULT.clock.dt:
        assert (cars == escape.states[step]).all()
    names = {"ego": 0, "trap 1": 1, "trap 2": 2} | {f"traffic {i - 2}": i for i in range(3, DEFAULT.vehicles)}
    assert {"ego", "trap 1", "trap 2"} <= set(drawn)
    for gid, place in drawn.items():
        car = cars[names[gid]]
        assert place == pytest.approx((car[X] - cars[EGO, X], car[Y], car[HEADING]), abs=1e-9)


def test_the_traces_are_the_drives_own_numbers(escape):
    assert (series(escape, "speed")[1] == escape.states[:, EGO, SPEED]).all()
    assert (series(escape, "distance")[1] == escape.states[:, EGO, X] - escape.states[:, TRAP_1, X]).all()
    assert series(escape, "return")[1][-1] == pytest.approx(escape.rewards.sum())
    assert np.abs(series(escape, "lane")[1] - escape.states[:, EGO, LANE]).max() <= 0.5 + 1e-9
    seconds, rewards = series(escape, "reward")
    assert seconds[-1] == 150 and len(seconds) == 151 and (rewards[1:] == escape.rewards).all()


def test_a_drive_has_overtaken_when_it_stays_ahead_and_a_moment_after_its_end_is_its_end(escape, idle, crash):
    passed, ahead = overtaken(escape), escape.states[:, EGO, X] > escape.states[:, TRAP_1, X]
    assert ahead[escape.times >= passed].all() and not ahead[escape.times == passed - DEFAULT.clock.dt].any()
    assert overtaken(idle) is None and overtaken(crash) is None
    figure = top_view_over_time(crash, times=[0, 2, 500, 600])  # a moment after the end becomes the end
    assert len(figure.axes) == 3 and "collision" in [text.get_text() for text in figure.texts]


def test_training_curves_show_the_paper_s_value_and_agents_that_ended_early():
    figure = training_curves({"sac": curves()}, "Paper", paper={"sac": {"return": 23.4, "success": 0.5}})
    assert figure.alt.startswith("Paper. ") and "4 agents" in figure.alt
    assert [ax.lines[-1].get_ydata()[0] for ax in figure.axes] == [50.0, 23.4]
    assert len(training_curves({"sac": curves(missing=120)}, "Three of four").axes[1].lines) == 4
    *agents, middle = training_curves({"sac": curves(missing=60)}, "Interrupted").axes[1].lines
    assert np.isfinite(agents[0].get_ydata()[-1]) and np.isnan(agents[-1].get_ydata()[-1])
    assert max(middle.get_xdata()) <= 60 and np.isfinite(middle.get_ydata()).all()


REFUSED = {
    "no moments": (lambda drive: top_view_over_time(drive, []), "give at least one moment"),
    "a negative moment": (lambda drive: top_view_over_time(drive, [-1]), "give at least one moment"),
    "no drive": (lambda drive: traces([]), "There is no drive to draw"),
    "an unknown panel": (lambda drive: traces(drive, what=["sped"]), "'sped' is unknown: did you mean 'speed'"),
    "no panel": (lambda drive: traces(drive, what=[]), "name one or more of speed"),
    "no curves": (lambda drive: training_curves({}, "Nothing"), "There are no curves"),
    "another curve": (lambda drive: training_curves({"sac": {"success": np.ones((2, 9))}}, ""), "have no 'return'"),
    "an empty curve": (
        lambda drive: training_curves({"sac": {name: np.full((2, 5), np.nan) for name in ("success", "return")}}, ""),
        "has not finished an episode",
    ),
    "an unknown format": (
        lambda drive: save(top_view_over_time(drive), "road.xyz"),
        "does not end in .png or .pdf or .svg",
    ),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_cannot_be_drawn_is_refused_in_one_sentence(idle, what):
    draw, sentence = REFUSED[what]
    with pytest.raises(BootcourseError, match=sentence):
        draw(idle)


def every_figure(escape, idle, crash):
    for drive in (escape, idle, crash):
        yield top_view_over_time(drive)
        yield traces(drive)
    yield traces([idle, escape, crash])
    yield training_curves({"sac": curves(), "bootstrapped": curves()}, "A title " * 12)
    yield animation.frame([idle, escape], 5.5)
    yield who_leaves({kind: np.random.default_rng(0).normal(size=(30, 5, 2)) for kind in ("one kind", "another")})
    yield escapes(shipped_experiment("easier"), easier.SHOWN)


def test_every_figure_has_alt_text_and_no_text_lies_on_another(escape, idle, crash):
    for figure in every_figure(escape, idle, crash):
        assert len(figure.alt) > 60 and "\n" not in figure.alt
        assert overlaps(figure) == []


def test_no_line_of_a_title_ends_inside_a_trap_s_name_or_a_number_and_its_unit():
    for part in ("trap 1", "44 s", "43 %", "γ = 0.8", "1 / (1 − γ)", "7 of 10"):
        for before in range(28, 40):
            assert part in wrapped("x" * before + " " + part + " " + "y" * 36)


def test_a_trap_s_name_lies_on_no_car(idle):
    cars = cars_at(idle, 0).copy()
    cars[3:, X] += 500
    named = []
    for ahead, behind in ((500, 500), (9, 500), (9, -9)):  # of trap 1: nobody near, one in front, one at each end
        cars[3, [X, Y]], cars[4, [X, Y]] = cars[TRAP_1, [X, Y]] + [ahead, 0], cars[TRAP_1, [X, Y]] + [behind, 0]
        cars[EGO, X] = cars[TRAP_1, X] - 30
        cars[TRAP_2, X] = cars[TRAP_1, X] + 400
        written = []

        class Canvas:
            def fill(self, *drawn): ...

            def words(self, x, y, words, colour, anchor="start", size=7.5, written=written):
                written.append((words, round(x - cars[TRAP_1, X]), round(y - cars[TRAP_1, Y])))

        draw_cars(Canvas(), cars, DEFAULT, "black", cars[EGO, X] - 20, cars[EGO, X] + 90, 0.0)
        named.append(next(place[1:] for place in written if place[0] == "trap 1"))
    assert named == [(3, 0), (-3, 0), (0, -4)]


def test_a_figure_says_what_it_shows_in_a_notebook_and_in_a_file(idle, tmp_path):
    figure = top_view_over_time(idle, [0])
    figure.alt = 'a "quoted" <word>'
    bundle = Picture(figure)._repr_mimebundle_()
    assert set(bundle) == {"text/html", "text/plain"} and bundle["text/plain"] == figure.alt
    assert 'alt="a &#34;quoted&#34; &lt;word&gt;"' in bundle["text/html"]
    assert png(traces(replace(idle, label="5 $ and $\\frac{"), what=["speed"])).startswith(b"\x89PNG"), "no formula"
    with Image.open(save(figure, tmp_path / "road.png")) as image:
        assert image.width == 770 and image.text["Description"] == figure.alt
    assert save(figure, tmp_path / "road.pdf").read_bytes().startswith(b"%PDF")
    assert b"<svg" in save(figure, tmp_path / "road.svg").read_bytes()
    assert png(figure) == png(figure), "the same figure has the same bytes"


def test_names_without_a_style_of_their_own_get_different_colours_and_lines():
    names = [f"mine, number {i}" for i in range(9)]
    first, *_, known = styles([*names[:3], "soft, mine"])
    assert first == style("mine") and known == style("soft")
    looks = styles(names)
    assert len({look.colour for look in looks[:4]}) == len({look.line for look in looks[:4]}) == 4
    assert len({(look.colour, look.line) for look in looks}) == 9 and styles(names + names) == looks + looks


# The picture of the README


def test_the_readme_s_picture_is_light():
    gif, still = FOLDER / "readme/trap.gif", FOLDER / "readme/trap.png"
    assert gif.stat().st_size <= 1_500_000 and still.stat().st_size <= 100_000
    with Image.open(io.BytesIO(gif.read_bytes())) as clip:
        assert clip.n_frames > 50 and clip.width == 770
