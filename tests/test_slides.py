"""The slides of a lesson: its predictions, figures and tables in their order, in one file that needs no network."""

import json
import re

import pytest

from bootcourse.course.lessons import stem
from tests.browser import needs_browser, open_browser
from tools.book import ROOT
from tools.course import slides
from tools.course.numbering import NOTEBOOKS

LESSONS = sorted(NOTEBOOKS.glob("*.ipynb"))
FIGURE = re.compile(r'<img [^>]*class="bc-figure"[^>]*alt="([^"]*)"')
ALT = re.compile(r'<img [^>]*alt="([^"]*)"')
TALL = "() => [...document.querySelectorAll('section')].filter(s => s.offsetHeight > innerHeight).map(s => s.innerText)"
HERE = "() => 1 + [...document.querySelectorAll('section')].findIndex(s => s.getBoundingClientRect().bottom > 9)"
SILENT = """() => [...document.querySelectorAll('.wide:not(.scrolls)')].filter(
  box => box.scrollWidth > box.clientWidth + 1).length"""


@pytest.fixture(scope="module")
def book(tmp_path_factory):
    folder = tmp_path_factory.mktemp("book")
    (folder / "teaching").mkdir()
    (folder / "slides.html").write_bytes((ROOT / "book/slides.html").read_bytes())
    slides.fill(folder)
    return folder


@pytest.fixture(scope="module")
def new_page(book):
    with open_browser(offline=True) as new_page:
        yield new_page


def outputs(path):
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    return ["".join(o.get("data", {}).get("text/html", "")) for cell in cells for o in cell.get("outputs", [])]


def deck(book, path):
    return (book / f"whole/slides/{path.stem}.html").read_text(encoding="utf-8")


@pytest.mark.parametrize("path", LESSONS, ids=lambda path: path.stem)
def test_a_lesson_s_slides_are_one_file_with_each_figure_and_prediction_in_its_place(book, path):
    page, pages = deck(book, path), outputs(path)
    wanted = [alt for html in pages for alt in FIGURE.findall(html)]
    shown = ALT.findall(page)
    assert [alt for alt in shown if alt in wanted] == wanted and all(shown)
    order = r"(Prediction \d+\.\d+)|" + FIGURE.pattern
    there = re.findall(r"(Prediction \d+\.\d+)\.</strong>|" + ALT.pattern, page)
    assert [each for each in there if each[0] or each[1] in wanted] == re.findall(order, "".join(
        html for html in pages if "bc-prediction" in html or "bc-figure" in html))  # fmt: skip
    assert len(page) < 1_000_000 and "{{" not in page
    assert re.findall(r"\b(?:src|href)=[\"'](?!data:)[^\"']*", page) == []
    assert f"../slides/{path.stem}.html" in (book / "teaching/slides.md").read_text(encoding="utf-8")


def test_a_slide_s_words_come_from_the_notebook_escaped():
    first = {"cell_type": "markdown", "source": "# 1 · <b>\n\n$\\gamma$ and [a link](other.ipynb)"}
    form = (
        '<div class="bc-prediction"><strong>Prediction 1.1</strong> How?<ul><li>a &lt; b</li></ul><div>no</div></div>'
    )
    quote = {"cell_type": "markdown", "source": "## Round 1\n\n> **Predict.** It may *fall*."}
    asked = {"cell_type": "code", "source": "predict('1.1')", "outputs": [{"data": {"text/html": [form]}}]}
    folded = {"cell_type": "code", "source": "source()", "outputs": [{"data": {"text/html": "<details><img alt='x'>"}}]}
    opening, question = slides.slides([first, quote, asked, folded])
    assert "&lt;b&gt;" in opening and "<math" in opening and "a link" in opening and "<a" not in opening
    assert "<h2>Round 1</h2>" in question and "<em>fall</em>" in question and "<li>a &lt; b</li>" in question


@needs_browser
def test_keys_turn_the_slides_and_each_fits_on_the_screen(book, new_page):
    page = new_page()
    page.page.goto((book / f"whole/slides/{stem('the_trap')}.html").as_uri())
    count = page.page.locator("section").count()
    assert all("Round 5" in text for text in page.page.evaluate(TALL)), "only the traces are taller, and scroll"
    seen = [page.page.evaluate(HERE)]
    for key in ("ArrowRight", " ", "ArrowDown", "ArrowLeft", "End", "Home"):
        page.page.keyboard.press(key)
        seen.append(page.page.evaluate(HERE))
    assert seen == [1, 2, 3, 4, 3, count, 1] and page.errors == []
    page.page.close()


@needs_browser
def test_on_a_phone_nothing_is_wider_than_the_screen_but_what_says_that_it_scrolls(book, new_page):
    page = new_page()
    page.page.set_viewport_size({"width": 390, "height": 844})
    page.page.emulate_media(color_scheme="dark")
    page.page.goto((book / f"whole/slides/{stem('the_rule')}.html").as_uri())
    assert page.page.evaluate("document.documentElement.scrollWidth") == 390
    assert page.page.evaluate(SILENT) == 0 and page.page.locator(".scrolls").count() > 3
    assert page.page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(18, 18, 18)"
    page.page.close()
