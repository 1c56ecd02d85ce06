"""Replays, panels and predictions where people meet them: in a real JupyterLab, in headless Chromium."""

import json
import re
import statistics

import pytest

from bootcourse.course.predictions import FILE
from tests.browser import ARTEFACTS, close_notice, is_blank, needs_browser
from tests.jupyterlab import open_lab
from tests.waiting import until

pytestmark = needs_browser
CHANGED = """(number, act) => new Promise(done => {
  const panel = document.querySelectorAll('.bc-panel')[number], svg = panel.querySelector('svg');
  const watch = new MutationObserver(() => { watch.disconnect(); done(performance.now() - start); });
  watch.observe(svg.parentElement, {childList: true});
  setTimeout(() => done(-1), 5000);
  const start = performance.now();
  (new Function('panel', act))(panel);
})"""

THINKING = """from bootcourse.learn.settings import settings_for
from bootcourse.learn.training import Training
from bootcourse.panels import policy_panel
from bootcourse.episodes.record import record
agent = Training([settings_for("bootstrapped", hidden=(16, 16))], 2).run(progress=False).agents[0]
drive = record(agent.as_policy(with_q=True), [1], label="bootstrapped")[0]
"""


@pytest.fixture(scope="module")
def open_notebook(tmp_path_factory):
    with open_lab(tmp_path_factory.mktemp("lab")) as open_notebook:
        yield open_notebook


# Replays


DRIVE = """from bootcourse.policies import rule_policy
from bootcourse.episodes.record import record
from bootcourse.scenario import DEFAULT
from bootcourse.replay3d import replay
drive = record(rule_policy(DEFAULT), [1], DEFAULT, "rule")[0]"""


def test_a_live_replay_plays_in_its_cell(open_notebook):  # a recording in a page: test_replay_export.py, test_book.py
    with open_notebook(DRIVE, "shown = replay(drive)\nshown") as notebook:
        notebook.page.set_viewport_size({"width": 800, "height": 600})  # WebGL is drawn by the processor here
        notebook.run_all()
        element = notebook.page.wait_for_selector(".jp-Cell:nth-of-type(2) iframe", timeout=30_000)
        element.scroll_into_view_if_needed()
        frame = element.content_frame()
        frame.wait_for_selector("canvas", timeout=30_000)
        frame.wait_for_function("() => window.__viserMutable?.nodeRefFromName?.['/drive0/car0/paint']")
        close_notice(frame)
        path = str(ARTEFACTS / "replay-in-jupyterlab.png")
        assert until(lambda: not is_blank(element.screenshot(path=path)))


# Panels


@pytest.fixture(scope="module")
def notebook(open_notebook):
    cells = (
        "from bootcourse.panels import drive_panel, train_panel\nmine = drive_panel(seed=3)\nmine",
        "trainer = train_panel('bootstrapped', seeds=2, episodes=5000)\ntrainer",
        THINKING + "weighed = policy_panel(drive)\nweighed",
        "from bootcourse.panels import bonus_panel\nbonus = bonus_panel()\nbonus",
        "from bootcourse.course import predict",
        "predict('the_barrier.1', 'Does <b>it</b> stay?', ['<i>yes</i>', 'no', 'perhaps'])",
        "predict('the_barrier.2', 'For how long?', unit='s')",
    )
    with open_notebook(*cells) as it:
        it.page.set_default_timeout(20_000)
        it.run_all()
        it.page.wait_for_selector(".bc-drive[data-bc-keys]")
        yield it


def panel(notebook, number):
    shown = notebook.page.locator(".bc-panel").nth(number)
    shown.scroll_into_view_if_needed()
    return shown


def button(notebook, number, called):
    return notebook.page.locator(".bc-panel").nth(number).get_by_role("button", name=called)


def changed(notebook, number, act):
    """Milliseconds from an act on a panel of the page to its new drawing."""
    notebook.page.wait_for_timeout(60)
    took = notebook.page.evaluate(f"([number, act]) => ({CHANGED})(number, act)", [number, act])
    assert took >= 0, "the drawing never changed"
    return took


def waits_for(notebook, number, words):
    notebook.page.wait_for_function(
        "([number, words]) => document.querySelectorAll('.bc-panel')[number].innerHTML.includes(words)",
        arg=[number, words],
    )


def test_the_arrow_keys_drive_and_two_at_once_are_one_action(notebook):
    shown, active = panel(notebook, 0), "jupyterapp.shell.currentWidget.content.activeCellIndex"
    shown.locator(".bc-keys").click()
    keys, cell = notebook.page.keyboard, notebook.page.evaluate(active)
    for seconds, together in enumerate((["ArrowUp"], ["ArrowDown"], ["ArrowDown", "ArrowLeft"], [" "]), start=1):
        for key in together:
            keys.down(key)
        for key in together:
            keys.up(key)
        waits_for(notebook, 0, f">{seconds} s<")
    assert notebook.page.evaluate(active) == cell, "the arrows do not go from cell to cell"
    shown.screenshot(path=str(ARTEFACTS / "drive-panel.png"))
    notebook.page.evaluate(
        "jupyterapp.shell.currentWidget.context.sessionContext.session.kernel.requestExecute("
        "{code: 'mine.say(str(mine.rollout.actions.tolist()))'})"
    )
    waits_for(notebook, 0, "[7, 1, 0, 4]")


def test_a_press_and_a_slider_show_their_effect_within_a_tenth_of_a_second(notebook):
    button(notebook, 0, "Drive again").click()
    took = [changed(notebook, 0, "panel.querySelector('.bc-pad-4').click()") for _ in range(8)]
    assert statistics.median(took) < 100, took
    took = []
    for key in ("ArrowLeft", "ArrowRight") * 4:
        panel(notebook, 2).locator(".noUi-handle").nth(1).focus()
        down = f"new KeyboardEvent('keydown', {{key: '{key}', bubbles: true, cancelable: true}})"
        took.append(changed(notebook, 2, f"panel.querySelectorAll('.noUi-handle')[1].dispatchEvent({down});"))
    panel(notebook, 2).screenshot(path=str(ARTEFACTS / "policy-panel.png"))
    assert statistics.median(took) < 100, took


def test_a_training_grows_on_the_page_stops_and_is_watched(notebook):
    shown = panel(notebook, 1)
    button(notebook, 1, "Train").press("Enter")
    waits_for(notebook, 1, "<circle")
    notebook.page.wait_for_function("document.activeElement.getAttribute('aria-label') === 'Stop'")
    waits_for(notebook, 1, "decisions/s")
    took = [changed(notebook, 0, "panel.querySelector('.bc-pad-4').click()") for _ in range(4)]
    shown.screenshot(path=str(ARTEFACTS / "train-panel.png"))
    button(notebook, 1, "Stop").click()
    waits_for(notebook, 1, "Stopped: ")
    button(notebook, 1, "Watch").click()
    frame = shown.locator("iframe").element_handle().content_frame()
    frame.wait_for_selector("canvas")
    assert statistics.median(took) < 200, took  # another panel answers while it trains


def test_the_keyboard_commits_a_prediction(notebook):
    shown = panel(notebook, 4)
    shown.locator("input[type=radio]").first.focus()
    for key in ("ArrowDown", "Tab", "Enter"):  # the arrow chooses, and one Tab leaves all three choices
        notebook.page.keyboard.press(key)
    waits_for(notebook, 4, "You predict: no.")
    assert "<i>yes</i>" in shown.inner_text()  # a choice is text; the question stands above the form
    panel(notebook, 5).locator("input").focus()
    notebook.page.keyboard.type("12")
    notebook.page.keyboard.press("Enter")
    waits_for(notebook, 5, "You predict: 12 s.")
    kept = json.loads((notebook.folder / FILE).read_text())
    assert (kept["the_barrier.1"]["answer"], kept["the_barrier.2"]["answer"]) == ("no", 12)


def test_each_control_of_a_panel_has_a_name_in_letters(notebook):
    controls = ".bc-panel [role=slider], .bc-panel input:not([type=radio], [type=checkbox]), .bc-panel button"
    names = notebook.page.locator(controls).evaluate_all(
        "each => each.map(one => one.getAttribute('aria-label') ?? '')"
    )
    assert len(names) > 30 and all(re.search("[a-z]{3}", name) for name in names), names
    assert "accelerate left" in names and "Prediction 4.2" in names


def test_the_panels_fit_their_column_and_the_console_has_no_error(notebook):
    widths = notebook.page.evaluate(
        "[...document.querySelectorAll('.bc-panel')].map(p => [p.scrollWidth, p.clientWidth])"
    )
    assert len(widths) == 6 and all(scroll <= client for scroll, client in widths)
    assert not [error for error in notebook.shown.errors if "WebGL" not in error]
