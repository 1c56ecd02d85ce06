"""The static book, as a reader without a server and without the network sees it."""

import contextlib
import re
import shutil
import subprocess

import nbformat
import pytest

import bootcourse as bc
from bootcourse.course.lessons import LESSONS, stem
from bootcourse.course.predictions import NOTHING
from bootcourse.panels.number import Number, whole_number
from tests.browser import ARTEFACTS, is_blank, needs_browser, open_browser
from tools import book, draggable
from tools.course.source import lesson_of, sources

FILES = [stem(name) for name in LESSONS]
# What sticks out of the screen, and what scrolls sideways without a line that says so. Code is known to scroll.
TOO_WIDE = """() => {
  const scrolls = e => ["auto", "scroll"].includes(getComputedStyle(e).overflowX);
  const inside = e => e.closest(".toc-drawer, .sidebar-drawer")
    || (e !== document.body && (scrolls(e) || inside(e.parentElement)));
  const all = [...document.body.querySelectorAll("*")], name = e => `${e.tagName}.${e.className}`;
  const out = all.filter(e => e.getBoundingClientRect().right > innerWidth + 1 && !inside(e));
  const silent = all.filter(e => e.tagName !== "PRE" && scrolls(e) && e.clientWidth && e.scrollWidth > e.clientWidth + 1
    && !getComputedStyle(e, "::before").content.includes("scroll"));
  return [...out, ...silent].map(name);
}"""


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The whole book, made once."""
    folder = tmp_path_factory.mktemp("book")
    book.gather(folder / "source", "instructor")
    assert book.build(folder / "source", folder / "html") == 0, "Sphinx has something to say: see above"
    return folder / "html"


@pytest.fixture(scope="module")
def new_page(made):
    with open_browser(width=1366, height=900, offline=True) as new_page:
        yield new_page


def test_every_lesson_has_its_pages(made):
    for name in FILES:
        assert all((made / f"{folder}/{name}.html").exists() for folder in ("lessons", "lessons/instructor"))
    listed = re.findall(r'href="lessons/(\w+)\.html"', (made / "index.html").read_text(encoding="utf-8"))
    assert [name for name in dict.fromkeys(listed) if name != stem("start")] == FILES[1:]


def test_a_notebook_that_somebody_has_worked_in_is_shown_as_it_came(tmp_path, monkeypatch):
    came, worked = (
        nbformat.v4.new_notebook(
            cells=[nbformat.v4.new_code_cell("predict()", outputs=[nbformat.v4.new_output("stream", text=said)])]
        )
        for said in ("as it came", "worked in")
    )
    (tmp_path / "notebooks").mkdir()
    notebook = tmp_path / "notebooks" / "00_start.ipynb"
    nbformat.write(came, notebook)
    without_git = book.as_it_came(notebook)
    for command in (["init", "-q"], ["add", "."]):
        subprocess.run(["git", "-C", str(tmp_path), *command], check=True)
    nbformat.write(worked, notebook)
    monkeypatch.setattr(book, "ROOT", tmp_path)
    assert book.worked_in() == ["00_start.ipynb"]
    book.as_a_page(notebook, tmp_path / "shown.ipynb")
    assert "as it came" in (tmp_path / "shown.ipynb").read_text() and "as it came" in without_git.decode()
    subprocess.run(["git", "-C", str(tmp_path), "add", "."], check=True)
    book.as_a_page(notebook, tmp_path / "shown.ipynb")
    assert "worked in" in (tmp_path / "shown.ipynb").read_text() and book.worked_in() == []


@pytest.mark.parametrize("path", sources(), ids=lesson_of)
def test_what_a_lesson_cites_is_in_the_bibliography(path):
    known = re.findall(r"eprint = \{([\d.]+)\}", (book.ROOT / "book/references.bib").read_text(encoding="utf-8"))
    cited = re.findall(r"\barXiv[\s:#]+(\d{4}\.\d{4,5})", path.read_text(encoding="utf-8"))
    assert [number for number in cited if number not in known] == []


def test_the_pages_are_linked_in_the_repository_too():
    pages = [page for page in (book.ROOT / "book").rglob("*.md") if page.name != "index.md"]
    pages += [book.ROOT / name for name in ("README.md", "CONTRIBUTING.md", "assets/report/report.md")]
    links = [(page, link) for page in pages for link in re.findall(r"\]\(([^)#\s:]+)[)#]", page.read_text("utf-8"))]
    assert len(links) > 40 and [(page, link) for page, link in links if not (page.parent / link).exists()] == []


def test_a_dead_link_stops_the_book(tmp_path, capfd):
    shutil.copy(book.ROOT / "book/conf.py", tmp_path)
    shutil.copy(book.ROOT / "book/style.css", tmp_path)
    (tmp_path / "index.md").write_text("# A\n\n[see](lessons/nothing.ipynb) and [see](#nothing)\n", encoding="utf-8")
    assert book.build(tmp_path, tmp_path / "html") != 0
    said = capfd.readouterr().err
    assert "not found: 'lessons/nothing.ipynb'" in said and "not found: 'nothing'" in said


def test_no_page_asks_the_network_for_anything(made):
    for path in made.rglob("*.html"):
        text = re.sub(r"<iframe .*?</iframe>", "", path.read_text(encoding="utf-8"), flags=re.S)
        loaded = re.findall(r"<(?:script|img|link|iframe|source)[^>]*?\b(?:src|href)=\"(https?:[^\"]*)", text)
        assert loaded == [], path.name


@needs_browser
@pytest.mark.parametrize(
    "name",
    ["index", "report/report", f"lessons/{stem('discrete_sac')}"],
)
def test_a_page_shows_its_pictures_its_equations_and_its_tables(made, new_page, name):
    page = new_page()
    page.page.goto((made / f"{name}.html").as_uri())
    page.page.wait_for_load_state()
    pictures = page.page.evaluate(
        "() => [...document.querySelectorAll('article img')].map(i => [i.alt, i.complete && i.naturalWidth > 0])"
    )
    assert all(alt and shown for alt, shown in pictures), pictures
    flat = page.page.evaluate(
        "() => [...document.querySelectorAll('article math')].filter(m => m.getBoundingClientRect().height < 4).length"
    )
    assert flat == 0
    text = page.page.inner_text("article")
    assert "$$" not in text and "\\frac" not in text and "| --- |" not in text
    assert page.errors == [] and all(url.startswith(("file:", "data:", "blob:", "about:")) for url in page.requests)
    if name.startswith("lessons/"):
        assert pictures, "a lesson without a picture"
    page.page.close()


@needs_browser
@pytest.mark.parametrize("name", ["index", "teaching/plans", f"lessons/{stem('the_trap')}"])
def test_on_a_phone_what_is_wider_than_the_screen_scrolls_inside_itself_and_says_so(made, new_page, name):
    page = new_page()
    page.page.set_viewport_size({"width": 390, "height": 844})
    page.page.goto((made / f"{name}.html").as_uri())
    for theme in ("light", "dark"):
        page.page.emulate_media(color_scheme=theme)
        assert page.page.evaluate(TOO_WIDE) == []
        assert page.page.evaluate("document.documentElement.scrollWidth") == 390
        figure = page.page.locator(".cell_output img.bc-figure").first
        if name.startswith("lessons/"):
            dark = "invert" in figure.evaluate("image => getComputedStyle(image).filter")
            assert dark == (theme == "dark") and page.page.locator(".bc-scrolls").count() > 3
    page.page.close()


@needs_browser
def test_an_explorable_follows_its_sliders_in_the_book(made, new_page):
    page = new_page()
    page.page.goto((made / f"lessons/{stem('values')}.html").as_uri())
    panel = page.page.locator(".draggable").first
    says = lambda: panel.locator(".picture title").text_content()  # noqa: E731
    first, sliders = says(), panel.locator("input").all()
    sliders[0].focus()
    page.page.keyboard.press("ArrowRight")
    moved, value = says(), panel.locator("output").first.text_content()
    assert moved != first and value != sliders[0].get_attribute("data-values").split(" ")[0]
    sliders[1].fill(sliders[1].get_attribute("max"))
    assert says() != moved and page.errors == []
    page.page.close()


def test_a_slider_in_the_book_has_the_ends_and_the_first_value_of_the_panel_s():
    number = Number("x", 0.3, 0, 1, 0.01, "a share")
    values, first = draggable.places(number, 15)
    assert len(values) <= 16 and (values[0], values[first], values[-1]) == (0, 0.3, 1)
    powers, first = draggable.places(Number("ξ", 0.01, 0.001, 10, 0.5, "a strength", logarithmic=True), 61)
    assert powers == [0, 0.001, 0.0032, 0.01, 0.032, 0.1, 0.32, 1.0, 3.2, 10.0] and powers[first] == 0.01
    whole = Number("n", 3, 1, 9, 0.5, "a number", check=whole_number("n", 1, 9))
    assert draggable.places(whole, 61) == ([1, 2, 3, 4, 5, 6, 7, 8, 9], 2)


@needs_browser
def test_a_replay_plays_in_the_book(made, new_page):
    page = new_page()
    page.page.goto((made / f"lessons/{stem('start')}.html").as_uri())
    shown = page.page.locator("iframe[title='Replay in 3D']")
    shown.scroll_into_view_if_needed()  # out of sight it is not laid out
    frame = shown.element_handle().content_frame()  # sandboxed: the page itself cannot look into it
    frame.wait_for_function("() => window.__viserMutable?.nodeRefFromName['/drive0/car0/paint']")
    before = frame.text_content("#bc-numbers table")
    frame.wait_for_function("before => document.querySelector('#bc-numbers table').textContent !== before", arg=before)
    picture = shown.screenshot(path=ARTEFACTS / "book-replay.png")
    assert not is_blank(picture) and page.errors == []
    page.page.close()


def test_a_world_in_a_lesson_is_the_live_page_in_the_book(tmp_path):
    cell = nbformat.v4.new_code_cell("bc.world(7)")
    with contextlib.closing(bc.world(7, ghosts=["sac", bc.idle_policy])) as world:
        data, _ = world._repr_mimebundle_()
    cell.outputs = [nbformat.v4.new_output("display_data", data)]
    nbformat.write(nbformat.v4.new_notebook(cells=[cell]), tmp_path / "lesson.ipynb")
    book.as_a_page(tmp_path / "lesson.ipynb", tmp_path / "page.ipynb")
    [output] = nbformat.read(tmp_path / "page.ipynb", 4).cells[0].outputs
    assert 'src="../trap.html#road=7&amp;ghost=sac&amp;driver=you' in output.data["text/html"]
    assert set(output.data) == {"text/html", "text/plain"}


def test_a_page_does_not_ask_for_what_takes_a_kernel(tmp_path):
    notebook = book.ROOT / "notebooks" / f"{stem('the_barrier')}.ipynb"
    book.as_a_page(notebook, tmp_path / "page.ipynb")
    came, page = notebook.read_text("utf-8"), (tmp_path / "page.ipynb").read_text("utf-8")
    for words in ("Run this cell to answer", "predictions committed", NOTHING):
        assert words in came and words not in page
    assert "Prediction 5.1" in page and "The answers are: 5.1: " in page


def test_where_a_lesson_trains_its_reader_trains_in_the_page_below_what_is_said_of_it(tmp_path):
    new, path = nbformat.v4, tmp_path / "lesson.ipynb"
    see = new.new_markdown_cell("See.\nIt learns.", metadata={"jupyter": {"source_hidden": True}})
    cells = [new.new_code_cell("bc.world()"), new.new_code_cell("training.run(updates=9)"), see]
    nbformat.write(new.new_notebook(cells=cells), path)
    book.add_learning(path, book.LEARNED["soft_constraint"])
    *before, learns = nbformat.read(path, 4).cells
    assert before == cells and learns.source.count('target="learn"') == 3
    assert 'name="learn" src="../trap.html#learn=soft&amp;agents=2' in learns.source


def test_the_page_that_learns_stands_in_place_of_a_panel_that_needs_a_kernel(tmp_path):
    new, path = nbformat.v4, tmp_path / "lesson.ipynb"
    cells = [new.new_code_cell("training.run(updates=9)"), new.new_code_cell("bc.panels.train_panel()")]
    cells[1].outputs = [new.new_output("stream", text="four empty axes")]
    nbformat.write(new.new_notebook(cells=cells), path)
    book.add_learning(path, book.LEARNED["soft_constraint"])
    trains, panel = nbformat.read(path, 4).cells
    assert trains == cells[0] and [list(each.data) for each in panel.outputs] == [["text/html", "text/plain"]]


def test_the_first_word_of_what_jupyterlab_folds_is_bold_in_the_book(tmp_path):
    see = nbformat.v4.new_markdown_cell("See.\n*It* learns.", metadata={"jupyter": {"source_hidden": True}})
    nbformat.write(nbformat.v4.new_notebook(cells=[see]), tmp_path / "lesson.ipynb")
    book.as_a_page(tmp_path / "lesson.ipynb", tmp_path / "page.ipynb")
    assert nbformat.read(tmp_path / "page.ipynb", 4).cells[0].source == "**See.** *It* learns."


@needs_browser
def test_what_the_book_lets_learn_is_what_the_page_takes(made, new_page):
    page = new_page()
    for lesson, addresses in book.LEARNED.items():
        for address in addresses.values():
            page.page.goto(f"{(made / 'trap.html').as_uri()}#{address}")
            page.page.reload()
            page.page.wait_for_function("() => window.trap?.ready")
            assert page.page.locator("#fault").is_hidden(), (lesson, address)
    page.page.close()


@needs_browser
def test_the_trap_is_driven_on_the_front_page(made, new_page):
    page = new_page()
    page.page.goto((made / "index.html").as_uri())
    page.page.locator("iframe").first.scroll_into_view_if_needed()
    frame = page.page.frame_locator("iframe").first
    frame.get_by_role("button", name="Start").click()
    frame.get_by_text("1 of 150 s").wait_for()
    assert page.errors == []
    page.page.close()
