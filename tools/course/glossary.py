"""What stands in book/glossary.md, and what the lessons set in bold because it is new."""

import re
import unicodedata
from dataclasses import dataclass

from tools.course.reference import BOOK, lessons, prose, text_of

PAGE = BOOK / "glossary.md"
GREEK = {name.split()[-1].lower(): chr(code) for code in range(0x3B1, 0x3CA) if (name := unicodedata.name(chr(code)))}
LESSON = re.compile(r" Lesson (\d+)\.$")

# Bold that labels a paragraph in a lesson's form (notebooks/source/README.md), with no full stop of its own.
LABELS = "Time, It builds on, You need, Read on, What you will be able to do, What you now know".split(", ")
# Bold that stresses something, or names a button, and introduces no word.
STRESSED = "drive, dt / τ above 2, keep as demonstration, lane, less, longer, never negative, our, speed, η = …"
STRESSED = STRESSED.split(", ")


@dataclass(frozen=True)
class Entry:
    """Some terms with one definition."""

    terms: tuple[str, ...]
    text: str  # without the lesson
    lesson: int | None  # the one that introduces it


def glossaries() -> list[list[Entry]]:
    """The page's glossaries: the words, then the symbols."""
    return [entries(block) for block in re.findall(r"^```\{glossary\}\n(.*?)^```$", text_of(PAGE), re.M | re.S)]


def entries(block: str) -> list[Entry]:
    """The entries of one {glossary} directive: lines of terms, and below them an indented definition."""
    found = []
    for part in re.split(r"\n\s*\n", block.strip("\n")):
        lines = part.splitlines()
        terms = tuple(line for line in lines if not line.startswith(" "))
        text = " ".join(line.strip() for line in lines if line.startswith(" "))
        named = LESSON.search(text)
        found.append(Entry(terms, LESSON.sub("", text), int(named[1]) if named else None))
    return found


def normalised(term: str) -> str:
    """A term without capitals and plurals: "Target networks" -> "target network"."""
    return " ".join(singular(word) for word in term.lower().split())


def singular(word: str) -> str:
    if len(word) > 3 and word.endswith("s") and not word.endswith(("ss", "us", "is")):
        return word[:-1]
    return word


def bold(text: str) -> list[str]:
    """The terms that a lesson's text sets in bold inside a sentence, in their order.

    Not those that label something: a bold that ends with a full stop or is followed by a colon, that begins a
    point of a list, or that is in `LABELS`; and nothing in a heading.
    """
    found = []
    for match in re.finditer(r"\*\*([^*]+?)\*\*(:?)", text):
        before = text[: match.start()].rsplit("\n", 1)[-1]
        words = " ".join(match[1].split())
        heading, point = before.startswith("#"), re.fullmatch(r"\s*(?:[-*]|\d+\.)\s+", before)
        label = (
            words in LABELS or re.search(r"[.:?!]$|\)\.$", words) or words.startswith(("Exercise ", "Three questions"))
        )
        names_line = match[2] and not before.strip("> ")  # "**The actor's**: minus ..."
        if not (heading or point or label or names_line):
            found.append(words)
    return found


def introduced() -> dict[str, int]:
    """Every term in bold, normalised, and the first lesson that has it so."""
    first = {}
    for number, path in sorted(lessons().items()):
        for term in bold(prose(path)):
            if normalised(term) not in STRESSED:
                first.setdefault(normalised(term), number)
    return first


def letters(text: str) -> str:
    r"""LaTeX's names as the letters that the glossary has: \xi D_\mathrm{KL} becomes ξ D_KL."""
    text = re.sub(r"\\tilde\{?\\pi\}?", "π̃", text)
    text = re.sub(r"\\(?:text|mathrm|mathcal|mathbb) ?|[{}^]", "", text)
    return re.sub(r"\\([a-z]+)", lambda name: GREEK.get(name[1], name[1]), text)


def uses(number: int, term: str, symbol: bool) -> bool:
    """Does a lesson use a word in its text (in any number), or a symbol in a formula or, if Greek, anywhere?"""
    text = prose(lessons()[number])
    if symbol:
        text = (
            " ; ".join(formula for _, formula in re.findall(r"(\$\$?)(.+?)\1", text, re.S)) if term.isascii() else text
        )
        return re.search(rf"(?<![A-Za-z]){re.escape(term)}(?![A-Za-z])", letters(text)) is not None
    plain = normalised(re.sub(r"[^\w\s'×=−-]", " ", text))
    return re.search(rf"(?<![\w-]){re.escape(normalised(term))}(?![\w-])", plain) is not None
