"""The text of a lesson's markdown cells as lines, and the numbers in it that say something.

A line is a paragraph, a point of a list, a heading or a row of a table, with single spaces. Its numbers are
those in digits, but for the ones that its form excuses: see `FORMS`, `is_question` and `quiet`. In a formula
a number counts where it is a value other than 0, behind a sign such as = or ≥, or has decimals; the others
are the formula's.
"""

import re
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path

from tools.course.source import read

# Each is a form, never a single sentence.
FORMS = {
    "code": r"`+[^`]*`+",
    "link": r"\[[^\]]*\]\([^)\s]+\)",
    "heading": r"^#.*",
    "announced exercise": r"\*\*Exercise \d+\.\d+ \([^)]*\)\.\*\*",
    "time, and what it builds on": r"^\*\*Time\*\*.*",
    "ordinal": r"^\d+\. |\b\d+(?:st|nd|rd|th)\b|(?<=\| )\d+ · ",
    "reference": r"\b(?:[Ll]esson|[Rr]ound|Equation|Table|Section|Algorithm|Figure|chapter|arXiv) \d+(?:\.\d+)*"
    r"|\b[Ll]essons \d+(?:(?:, | to | and )\d+)*",
    "name": r"\b(?:[Tt]raps?|[Ll]anes?|[Ss]eeds?|[Rr]ows?|[Cc]ars?|[Aa]gents?) \d+\b(?! m\b)",
    "year": r"\b(?:19|20)\d\d(?=\))",
    "volume (year) page": r"\b\d+ \(\d{4}\) \d+\b",
    "level of an interval": r"\b95 %(?= (?:\*?intervals?|confidence|bands?)\b)",
    "one minus, plus one": r"\b1 − (?=[^\W\d])|(?<=\b[^\W\d] [+−] )1\b",
}
FORM = re.compile("|".join(f"(?:{form})" for form in FORMS.values()))
FORMULA = re.compile(r"\$\$.*?\$\$|\$.*?\$")
VALUE = re.compile(r"(?:[=<>≈≤≥]|\\(?:le|ge|approx|in)\b)\s*$")
DIGITS = re.compile(r"(?<![A-Za-z_\d^])(?<!\d\.)(?:(?<![\w)}\]])[−-])?\d(?:[\d,]*\d)?(?:\.\d+)?(?![A-Za-z_\d])")
IN_WORDS = dict(
    zip("two three four five six seven eight nine ten eleven twelve".split(), range(2, 13), strict=True)
) | {"twenty": 20, "twenty-four": 24, "thirty": 30}
WORDS = re.compile(rf"\b(?:{'|'.join(sorted(IN_WORDS, key=len, reverse=True))})\b", re.I)


@dataclass(frozen=True)
class Number:
    """A number as it is printed, and where it stands in its text."""

    printed: str
    start: int
    end: int

    @property
    def value(self) -> Decimal:
        word = IN_WORDS.get(self.printed.lower())
        return Decimal(word if word else self.printed.replace(",", "").replace("−", "-"))

    def agrees(self, computed: float) -> bool:
        """Is it the computed one, rounded to as many decimals as it has? (A half may go either way.)"""
        half = Decimal("0.5").scaleb(self.value.as_tuple().exponent)
        return abs(Decimal(repr(float(computed))) - self.value) <= half + Decimal("1e-9")


@dataclass(frozen=True)
class Line:
    """One line of prose; `quiet` ones ask: a prediction, or one of the three questions."""

    text: str
    quiet: bool

    @property
    def numbers(self) -> list[Number]:
        """The numbers that need evidence."""
        if self.quiet:
            return []
        text = FORM.sub(lambda match: " " * len(match[0]), self.text)
        for start, end in sentences(text):
            if is_question(text[start:end]):
                text = text[:start] + " " * (end - start) + text[end:]
        inside = [match.span() for match in FORMULA.finditer(text)]
        return [
            number
            for number in digits(text)
            if not any(start < number.start < end for start, end in inside)
            or "." in number.printed
            or (number.value and VALUE.search(text[: number.start]))
        ]


def digits(text: str) -> list[Number]:
    """All numbers in digits."""
    return [Number(match[0], *match.span()) for match in DIGITS.finditer(text)]


def in_words(text: str) -> list[Number]:
    """All numbers in words, from two on."""
    return [Number(match[0], *match.span()) for match in WORDS.finditer(text)]


def sentences(text: str) -> list[tuple[int, int]]:
    """Where the sentences of a line begin and end; what stands before a colon is one, too."""
    ends = [match.end() for match in re.finditer(r"[.!?:][\"”')*]*(?= )", text)] + [len(text)]
    return list(zip([0, *ends[:-1]], ends, strict=True))


def is_question(sentence: str) -> bool:
    return re.search(r"\?[\"”')*]*$", sentence.rstrip()) is not None


def prose(path: Path) -> list[Line]:
    """All lines of a lesson's markdown cells, the instructor's notes included."""
    return [line for cell in read(path) if not cell.is_code for line in lines(cell.student)]


def lines(cell: str) -> list[Line]:
    """The lines of one markdown cell, without blocks of code and without the mark > of a quotation."""
    cell = re.sub(r"^```.*?^```", "", cell, flags=re.M | re.S)
    cell = re.sub(r"^(#.*)$", r"\1\n", cell, flags=re.M)  # a heading ends with its line
    found, quiet = [], False
    for block in re.split(r"\n[> ]*\n", cell):
        quoted = block.lstrip().startswith(">")
        parts = re.split(r"^(?=- |\d+\. |\|)", re.sub(r"^> ?", "", block, flags=re.M), flags=re.M)
        texts = [" ".join(part.split()) for part in parts if part.strip()]
        if texts and not (quiet and quoted):  # a quotation may go on after an empty line
            quiet = texts[0].startswith(("**Predict.**", "**Three questions"))
        found += [Line(text, quiet) for text in texts]
    return found
