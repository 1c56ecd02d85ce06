"""The figures: what is drawn is what was driven, everything has words, and bad input gets a sentence."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.colors import to_hex
from PIL import Image

from bootcourse.colours import ALARM, TRAP
from bootcourse.episodes.rollout import series
from bootcourse.episodes.words import cars_at, doing, overtaken
from bootcourse.errors import BootcourseError
from bootcourse.methods import style
from bootcourse.plots import animation
from bootcourse.plots.figure import Picture, finish, label_ends, new_figure, plain_axes, png, save, styles
from bootcourse.plots.top_view import key_moments, top_view_over_time, window
from bootcourse.plots.traces import PANELS, traces
from bootcourse.plots.training_curves import training_curves
from bootcourse.road.state import EGO, HEADING, LANE, SPEED, TRAP_1, X, Y
from bootcourse.scenario import DEFAULT


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


def words_of(figure) -> list[str]:
    return [text.get_text() for ax in figure.axes for text in ax.texts] + [text.get_text() for text in figure.texts]


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


def test_drivers_and_cars_have_their_colours_and_the_same_figure_has_the_same_bytes(escape):
    bodies = {patch.get_gid(): patch for patch in top_view_over_time(escape, [0]).axes[0].patches if patch.get_gid()}
    assert to_hex(bodies["ego"].get_facecolor()).upper() == style("rule").colour
    assert to_hex(bodies["trap 1"].get_facecolor()).upper() == TRAP
    first, second, third = styles(["you", "idle", "you"])  # two drivers of one colour get two lines
    assert first.colour == second.colour and first.line != second.line and first == third
    assert png(traces(escape, what=["speed"])) == png(traces(escape, what=["speed"]))


def test_the_key_moments_are_few_in_order_and_within_the_drive(escape, idle, crash):
    for drive in (escape, idle, crash):
        moments = key_moments(drive)
        assert 2 <= len(moments) <= 6 and moments == sorted(moments) and moments[0] == 0
        assert moments[-1] <= drive.times[-1] and min(np.diff(moments)) >= 1
    assert key_moments(crash)[-1] == crash.times[-1] and doing(crash, crash.times[-1]) == "collision"


def test_what_is_out_of_the_picture_is_named_at_its_edge(escape):
    end = float(escape.times[-1])
    gap = escape.states[-1, EGO, X] - escape.states[-1, TRAP_1, X]
    assert f"◂ trap 1, {gap:.0f} m behind" in words_of(top_view_over_time(escape, [end]))
    left, right = window(escape, [0, end])
    assert right - left <= 150


def test_the_traces_are_the_drives_own_numbers(escape):
    assert (series(escape, "speed")[1] == escape.states[:, EGO, SPEED]).all()
    assert (series(escape, "distance")[1] == escape.states[:, EGO, X] - escape.states[:, TRAP_1, X]).all()
    assert series(escape, "return")[1][-1] == pytest.approx(escape.rewards.sum())
    assert np.abs(series(escape, "lane")[1] - escape.states[:, EGO, LANE]).max() <= 0.5 + 1e-9
    seconds, rewards = series(escape, "reward")
    assert seconds[-1] == 150 and len(seconds) == 151 and (rewards[1:] == escape.rewards).all()


def test_a_drive_in_words_names_its_manoeuvres_and_when_it_overtook(escape, idle, crash):
    words = words_of(top_view_over_time(escape))
    assert {"falls back", "changes lane, left", "catches up", "ahead of trap 1"} <= set(words)
    passed, ahead = overtaken(escape), escape.states[:, EGO, X] > escape.states[:, TRAP_1, X]
    assert ahead[escape.times >= passed].all() and not ahead[escape.times == passed - DEFAULT.clock.dt].any()
    assert overtaken(idle) is None and overtaken(crash) is None
    figure = top_view_over_time(crash, times=[0, 2, 500, 600])  # a moment after the end becomes the end
    assert len(figure.axes) == 3 and "collision" in words_of(figure)
    assert [line for line in figure.axes[-1].lines if line.get_gid() == "accident"]


def test_every_trace_has_a_label_with_its_unit_and_every_drive_a_name(escape, idle):
    figure = traces([idle, escape])
    labels = [ax.get_ylabel() for ax in figure.axes]
    assert len(labels) == len(PANELS) + 1 and all(labels)
    assert labels[0] == "speed (m/s)" and labels[1].startswith("distance ahead of trap 1 (m)")
    assert figure.axes[-1].get_xlabel() == "time (s)"
    assert {"±1 m/s²", "±3.6° of steering"} <= set(words_of(figure))
    assert {"rule controller", "idle driver", "the traps"} <= {text.get_text() for text in figure.axes[0].texts}
    again = traces([escape, replace(escape, seed=4)], what=["speed"]).axes
    names = {text.get_text() for text in again[0].texts}
    assert {"rule controller,\nroad 3", "rule controller,\nroad 4"} <= names
    assert again[0].get_ylabel() == PANELS["speed"][0] and again[0].get_xlim() == (0, 150)


def test_an_accident_is_marked_and_named(crash):
    figure = traces(crash)
    assert "collision" in words_of(figure)
    for ax in figure.axes[:-1]:
        cross = [line for line in ax.lines if line.get_gid() == "accident"]
        assert len(cross) == 1 and cross[0].get_color() == ALARM and cross[0].get_xdata()[0] == crash.times[-1]


def test_each_line_of_a_title_is_a_sentence_of_the_alt_text_and_a_wrapped_one_is_one_sentence(escape, idle):
    two = traces([idle, escape], what=("speed",))
    assert two._suptitle.get_text().count("\n") == 1 and " after 150 s. Rule controller: ahead" in two.alt
    long = "One sentence that is so long that it has no place in a single line of the title of a figure"
    wrapped = traces(escape, long, what=("speed",))
    assert wrapped._suptitle.get_text().count("\n") == 1 and wrapped.alt.startswith(f"{long}. Over ")


def test_training_curves_have_labels_names_and_the_callers_title():
    figure = training_curves({"sac": curves(), "bootstrapped": curves()}, "The trap opens", {"rule": {"return": 25.0}})
    assert figure.alt.startswith("The trap opens. ") and "4 agents" in figure.alt
    success, returns = figure.axes
    assert "%" in success.get_ylabel() and "return" in returns.get_ylabel()
    assert success.get_xlabel() == returns.get_xlabel() == "training episode"
    assert {"plain SAC", "bootstrapped SAC", "rule controller"} <= {text.get_text() for text in returns.texts}
    assert any("over the last 30 episodes" in text.get_text() for text in figure.texts)
    figure = training_curves({"sac": curves()}, "Paper", paper={"sac": {"return": 23.4, "success": 0.5}})
    success, returns = (ax.lines[-1] for ax in figure.axes)  # the paper's value is an open diamond
    assert (returns.get_marker(), returns.get_markerfacecolor()) == ("D", "white")
    assert [line.get_ydata()[0] for line in (success, returns)] == [50.0, 23.4]
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


def test_every_figure_has_alt_text_and_no_text_lies_on_another(escape, idle, crash):
    for figure in every_figure(escape, idle, crash):
        assert len(figure.alt) > 60 and "\n" not in figure.alt
        assert overlaps(figure) == []


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


def test_labels_that_meet_are_moved_apart_and_keep_their_order():
    figure = new_figure()
    ax = figure.add_axes((0.1, 0.1, 0.7, 0.8))
    plain_axes(ax, "height (m)")
    label_ends(ax, [(0.5, "one", "k"), (0.5, "two", "k"), (0.51, "three", "k"), (0.0, "four", "k")])
    assert overlaps(finish(figure, "Labels", "Labels that meet.")) == []
    heights = {text.get_text(): text.get_position()[1] for text in ax.texts}
    assert 0 == heights["four"] < heights["one"] < heights["two"] < heights["three"]


def test_names_without_a_style_of_their_own_get_different_colours_and_lines():
    names = [f"mine, number {i}" for i in range(9)]
    first, *_, known = styles([*names[:3], "soft, mine"])
    assert first == style("mine") and known == style("soft")
    looks = styles(names)
    assert len({look.colour for look in looks[:4]}) == len({look.line for look in looks[:4]}) == 4
    assert len({(look.colour, look.line) for look in looks}) == 9 and styles(names + names) == looks + looks
