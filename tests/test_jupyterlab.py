"""Replays, panels and predictions where people meet them: in a real JupyterLab, in headless Chromium."""

import json
import re
import statistics

import pytest

from bootcourse.course.predictions import FILE, number_of
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

WORLD = ".jp-OutputArea [data-lm-suppress-shortcuts]"
FRAMES = """async host => {  // pictures from a key to its arrow, with a clock that waits for decisions
    const pad = host.shadowRoot.getElementById('pad'), shell = host.shadowRoot.getElementById('shell'), took = [];
    const send = (kind, key) => shell.dispatchEvent(new KeyboardEvent(kind, { key, bubbles: true, composed: true }));
    const until = async test => {
        let frames = 0;
        while (!test() && frames < 300) { await new Promise(requestAnimationFrame); frames++; }
        return frames;
    };
    const coming = () => pad.querySelector('.coming');
    for (const key of ['ArrowUp', 'ArrowDown', 'ArrowLeft', 'ArrowRight']) {
        if (await until(() => !coming()) === 300) return [300];
        send('keydown', key);
        took.push(await until(coming));
        send('keyup', key);
    }
    return took;
}"""
TRAINED = """from bootcourse.storage.assets import FOLDER
agent = bc.load_run(FOLDER / "runs/bootstrapped-4").agent
"""
THINKING = """from bootcourse.learn.settings import settings_for
from bootcourse.learn.training import Training
from bootcourse.panels import policy_panel
from bootcourse.episodes.record import record
agent = Training([settings_for("bootstrapped", hidden=(16, 16))], 2).run(progress=False).agents[0]
drive = record(agent.as_policy(with_q=True), [1], label="bootstrapped")[0]
"""


DRIVE = """from bootcourse.policies import rule_policy
from bootcourse.episodes.record import record
from bootcourse.scenario import DEFAULT
from bootcourse.replay3d import replay
drive = record(rule_policy(DEFAULT), [1], DEFAULT, "rule")[0]"""

CELLS = {  # of one notebook, so that the tests wait for one page and one kernel; a test runs the cells of a name
    "worlds": (
        "import bootcourse as bc\nmine = bc.world(road=3, ghosts=[])\nmine",
        TRAINED + "learned = bc.world(4, driver=agent, ghosts={'the same': agent})\nlearned",
        "def my_rule(cars, scenario):\n    return 1 if cars[0, 3] > 8 else 4\n"
        "ruled = bc.world(5, driver=my_rule, ghosts=[bc.rule_policy(bc.DEFAULT)], details=True)\nruled",
        "def broken(cars, scenario):\n    return 9\nwrong = bc.world(5, driver=broken)\nwrong",
    ),
    "panels": (
        "from bootcourse.panels import train_panel\n"
        "trainer = train_panel('bootstrapped', seeds=2, episodes=5000)\ntrainer",
        THINKING + "weighed = policy_panel(drive)\nweighed",
        "from bootcourse.panels import bonus_panel\nbonus = bonus_panel()\nbonus",
        "from bootcourse.course import predict\npredict('the_barrier.1', 'Does <b>it</b> stay?', "
        "['<i>yes</i>', 'no', 'perhaps'])",
        "predict('the_barrier.2', 'For how long?', unit='s')",
    ),
    "predictions": (
        "from bootcourse.course import predict, predicted, progress\nprogress('the_rule')",
        'predict("the_rule.1", "Which?", ["none", "some"])',
        'predicted("the_rule.1")\nprint(7)' + 150 * "\n#",  # the next question is far off screen
        'predict("the_rule.2", "Which?", ["none", "some"])',
        'predicted("the_rule.2")\nprint(7)',
    ),
    "training": (
        "from bootcourse.learn.settings import settings_for\nfrom bootcourse.learn.training import Training\n"
        "result = Training([settings_for('bootstrapped', learning_starts=64)], 20_000).run()",
        "print('interrupted' if result.interrupted else 'whole', len(result.agents))",
    ),
    "replay": (DRIVE, "shown = replay(drive)\nshown"),
    "ended": ("from bootcourse.course.lessons.values.explorable import worths\nworths()",),
}


def place_of(name: str) -> tuple[int, int]:
    """The numbers of the first and the last cell of a name."""
    names = [each for each, cells in CELLS.items() for _ in cells]
    return names.index(name), len(names) - 1 - names[::-1].index(name)


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    cells = [cell for each in CELLS.values() for cell in each]
    with open_lab(tmp_path_factory.mktemp("lab")) as open_notebook, open_notebook(*cells, saved="as it came") as it:
        it.page.set_default_timeout(20_000)
        yield it


# Worlds


@pytest.fixture(scope="module")
def worlds(page):
    page.run(*place_of("worlds"))
    page.page.wait_for_function(f"() => document.querySelectorAll('{WORLD}').length === 4")
    return page


def world(worlds, number):
    shown = worlds.page.locator(WORLD).nth(number)
    shown.scroll_into_view_if_needed()
    return shown


def answer(worlds, code):
    """What the kernel prints."""
    return worlds.page.evaluate(
        """async code => {
            const kernel = jupyterapp.shell.currentWidget.context.sessionContext.session.kernel;
            const run = kernel.requestExecute({ code }), said = [];
            run.onIOPub = ({ content }) => said.push(content.text ?? content.evalue ?? "");
            await run.done;
            return said.join("").trim();
        }""",
        code,
    )


# Press keys at once, where the focus is: between two calls from here a busy machine takes longer than the page waits.
TOGETHER = """keys => {
    let focus = document.activeElement;
    while (focus.shadowRoot?.activeElement) focus = focus.shadowRoot.activeElement;
    for (const type of ["keydown", "keyup"]) {
        for (const key of keys) focus.dispatchEvent(new KeyboardEvent(type, { key, bubbles: true, composed: true }));
    }
}"""


def test_the_arrow_keys_drive_where_the_focus_is_and_leave_the_notebook_alone(worlds):
    shown, keys = world(worlds, 0), worlds.page.keyboard
    shown.get_by_role("button", name="step").click()
    shown.locator("#road").click()
    place = "[jupyterapp.shell.currentWidget.content.activeCellIndex, document.querySelectorAll('.jp-Cell').length]"
    before, high = worlds.page.evaluate(place), shown.bounding_box()["y"]
    for time, press in enumerate((["ArrowUp"], ["ArrowDown"], ["ArrowDown", "ArrowLeft"]), start=1):
        if len(press) == 1:
            keys.press(*press)
        else:
            worlds.page.evaluate(TOGETHER, press)
        assert until(lambda time=time: shown.locator("#clock").inner_text() == f"{time} of 150 s")
    for key in ("d", "d", "b", "x"):  # the notebook's: delete the cell, a new one below, cut
        keys.press(key)
    assert worlds.page.evaluate(place) == before and shown.bounding_box()["y"] == high, "nothing scrolls"
    shown.screenshot(path=str(ARTEFACTS / "world.png"))
    keys.press("Escape")
    keys.press("ArrowDown")
    assert until(lambda: worlds.page.evaluate(place) == [before[0] + 1, before[1]]), "Escape gives the keys back"
    assert until(lambda: answer(worlds, "print(mine.drive.actions.tolist()[:3])") == "[7, 1, 0]")


@pytest.mark.parametrize("number, name", [(1, "learned"), (2, "ruled")])
def test_an_agent_drives_in_the_page_and_a_rule_of_the_readers_in_python(worlds, number, name):
    shown = world(worlds, number)
    shown.get_by_role("button", name="5×").click()
    shown.get_by_role("button", name="Start").click()
    assert until(
        lambda: answer(worlds, f"print({name}.drive is not None and len({name}.drive.actions) > 2)") == "True", 60
    )
    shown.screenshot(path=str(ARTEFACTS / f"world-{name}.png"))
    driver = "agent.as_policy()" if name == "learned" else "bc.teacher_policy(my_rule)"
    again = f"[again] = bc.record({driver}, [{name}.drive.seed])\ndriven = {name}.drive.actions\n"
    assert answer(worlds, again + "print((again.actions[:len(driven)] == driven).all())") == "True"


def test_a_rule_that_fails_is_one_sentence_on_the_road(worlds):
    shown = world(worlds, 3)
    assert until(lambda: "Your rule 'broken' failed" in shown.locator("#message").inner_text())
    assert worlds.shown.errors == []


def test_a_key_is_seen_two_pictures_later_and_the_module_is_there_once(worlds):
    took = worlds.page.locator(WORLD).nth(0).evaluate(FRAMES)
    assert 0 < min(took) <= max(took) <= 2, took  # 33 ms at 60 pictures a second
    assert answer(worlds, "print(len({id(each.library) for each in (mine, learned, ruled)}))") == "1"


# Panels


@pytest.fixture(scope="module")
def notebook(page):
    page.clear(*place_of("worlds"))  # their cars go on driving
    page.run(*place_of("panels"))
    page.page.wait_for_selector(".bc-panel[data-bc-named]")
    return page


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


def test_a_slider_shows_its_effect_within_a_tenth_of_a_second(notebook):
    took = []
    for key in ("ArrowLeft", "ArrowRight") * 4:
        panel(notebook, 1).locator(".noUi-handle").nth(1).focus()
        down = f"new KeyboardEvent('keydown', {{key: '{key}', bubbles: true, cancelable: true}})"
        took.append(changed(notebook, 1, f"panel.querySelectorAll('.noUi-handle')[1].dispatchEvent({down});"))
    panel(notebook, 1).screenshot(path=str(ARTEFACTS / "policy-panel.png"))
    assert statistics.median(took) < 100, took


def test_a_training_grows_on_the_page_and_stops(notebook):
    shown = panel(notebook, 0)
    train, road = button(notebook, 0, "Train"), shown.locator("#road")
    height = lambda: train.bounding_box()["y"] - shown.bounding_box()["y"]  # noqa: E731
    before = height()
    train.press("Enter")
    waits_for(notebook, 0, "<circle")
    notebook.page.wait_for_timeout(700)
    assert abs(height() - before) < 5, "the sliders stay where they are"
    curves = shown.get_by_role("img", name="Training curves").first  # it is drawn anew all the time

    def is_beside() -> bool:
        drawn = curves.bounding_box()
        return drawn is not None and road.bounding_box()["x"] >= drawn["x"] + drawn["width"]

    assert until(is_beside), "the road stands beside the curves"
    notebook.page.wait_for_function("document.activeElement.getAttribute('aria-label') === 'Stop'")
    waits_for(notebook, 0, "episodes in")
    assert until(lambda: re.match("[1-9]", shown.locator("#clock").inner_text())), "the present agent drives"
    shown.screenshot(path=str(ARTEFACTS / "train-panel.png"))
    button(notebook, 0, "Stop").first.click()
    waits_for(notebook, 0, "Stopped: ")


def test_the_keyboard_commits_a_prediction(notebook):
    shown = panel(notebook, 3)
    shown.locator("input[type=radio]").first.focus()
    for key in ("ArrowDown", "Tab", "Enter"):  # the arrow chooses, and one Tab leaves all three choices
        notebook.page.keyboard.press(key)
    waits_for(notebook, 3, "You predict: no.")
    assert "<i>yes</i>" in shown.inner_text()  # a choice is text; the question stands above the form
    panel(notebook, 4).locator("input").focus()
    notebook.page.keyboard.type("12")
    notebook.page.keyboard.press("Enter")
    waits_for(notebook, 4, "You predict: 12 s.")
    kept = json.loads((notebook.folder / FILE).read_text())
    assert (kept["the_barrier.1"]["answer"], kept["the_barrier.2"]["answer"]) == ("no", 12)


def test_each_control_of_a_panel_has_a_name_in_letters(notebook):
    controls = ".bc-panel [role=slider], .bc-panel input:not([type=radio], [type=checkbox]), .bc-panel button"
    names = notebook.page.locator(controls).evaluate_all(
        "each => each.filter(one => one.getRootNode() === document).map(one => one.getAttribute('aria-label') ?? '')"
    )
    assert len(names) > 20 and all(re.search("[a-z]{3}", name) for name in names), names
    assert f"Prediction {number_of('the_barrier.2')}" in names


def test_the_panels_fit_their_column_and_the_console_has_no_error(notebook):
    widths = notebook.page.evaluate(
        "[...document.querySelectorAll('.bc-panel')].map(p => [p.scrollWidth, p.clientWidth])"
    )
    assert len(widths) == 5 and all(scroll <= client for scroll, client in widths)
    assert not [error for error in notebook.shown.errors if "WebGL" not in error]


# Predictions, trainings, replays, and the end


def test_a_saved_result_is_folded_until_its_prediction_is_committed(page):
    first, _ = place_of("predictions")
    folded = page.page.locator(".jp-OutputPlaceholder")
    assert folded.count() == 2
    page.run(first, first + 1)
    page.cell(first + 1).locator("input[type=radio]").last.check()
    assert folded.count() == 2
    page.cell(first + 1).get_by_role("button", name="Commit").click()
    page.page.wait_for_function("() => document.querySelectorAll('.jp-OutputPlaceholder').length === 1")
    assert page.page.locator(".bc-progress").inner_text().startswith("This lesson: 1 of ")
    for _ in range(2):  # the notebook has the focus again, and hears keys
        page.page.keyboard.press("Shift+Enter")
        page.page.wait_for_timeout(500)
    page.page.get_by_text(f"You predicted ({number_of('the_rule.1')}): some. Was it so?").wait_for()
    page.page.screenshot(path=str(ARTEFACTS / "prediction.png"))


def test_a_training_is_watched_in_its_cell_and_the_road_s_button_stops_it(page):
    first, last = place_of("training")
    page.begin(first, last)
    watched = page.cell(first)
    road = watched.locator(WORLD)
    clock = lambda: road.locator("#clock").inner_text()  # noqa: E731
    assert until(lambda: re.match("[1-9]", clock()), 60), "the present agent drives"
    assert until(lambda: "now, after" in road.locator("#driver").inner_text())
    watched.locator("svg circle").first.wait_for()
    watched.locator(".jp-OutputArea-output").first.screenshot(path=str(ARTEFACTS / "watched.png"))
    watched.get_by_role("button", name="Stop, and keep what was learned").click()
    page.cell(last).get_by_text("interrupted 1").wait_for()
    assert "You stopped it after" in watched.locator(".jp-OutputArea").first.inner_text()
    assert page.shown.errors == []


def test_a_live_replay_plays_in_its_cell(page):  # a recording in a page: test_replay_export.py, test_book.py
    page.page.set_viewport_size({"width": 800, "height": 600})  # WebGL is drawn by the processor here
    page.run(*place_of("replay"))
    element = page.cell(place_of("replay")[1]).locator("iframe").element_handle(timeout=30_000)
    element.scroll_into_view_if_needed()
    frame = element.content_frame()
    frame.wait_for_selector("canvas", timeout=30_000)
    frame.wait_for_function("() => window.__viserMutable?.nodeRefFromName?.['/drive0/car0/paint']")
    close_notice(frame)
    path = str(ARTEFACTS / "replay-in-jupyterlab.png")
    assert until(lambda: not is_blank(element.screenshot(path=path)))
    page.clear(*place_of("replay"))


def test_a_panel_whose_kernel_has_ended_says_so_once(page):
    page.run(*place_of("ended"))
    shown = page.cell(place_of("ended")[0])
    shown.locator(".bc-panel").wait_for()
    page.page.evaluate("() => jupyterapp.shell.currentWidget.sessionContext.session.kernel.restart()")
    marks = "them => them.map(each => getComputedStyle(each, '::before').content).filter(mark => mark !== 'none')"
    said = lambda: shown.locator(".bc-panel, .bc-panel *").evaluate_all(marks)  # noqa: E731
    assert until(lambda: said() == ['"The kernel has ended: run this cell again."'])


def test_a_panel_is_there_again_when_its_notebook_is_opened_without_its_kernel(page):
    number, _ = place_of("ended")
    page.run(number, number)
    page.cell(number).locator(".bc-panel svg").wait_for()
    page.page.evaluate("() => jupyterapp.commands.execute('docmanager:save')")
    page.page.evaluate("() => jupyterapp.shell.currentWidget.sessionContext.session.kernel.restart()")
    page.page.reload()
    page.page.wait_for_function(f"() => jupyterapp.shell.currentWidget?.content.widgets?.length === {number + 1}")
    page.page.evaluate(f"() => jupyterapp.shell.currentWidget.content.scrollToItem({number})")
    page.cell(number).locator(".bc-panel svg").wait_for()
    assert page.page.get_by_text("model not found").count() == 0
