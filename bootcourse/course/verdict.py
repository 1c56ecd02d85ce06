"""The result of a check: a sentence, with numbers where they help, as HTML and as plain text."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from bootcourse.markup import Markup, html, joined
from bootcourse.terminal import printable

if TYPE_CHECKING:
    from bootcourse.course.exercise import Mistake

# library: right, and the library's own; wrong: it ran; did_not_run: it raised an error, took too long, or ended its
# process; broke: our check broke off, whatever the answer is; todo: nothing to judge yet
Kind = Literal["passed", "library", "wrong", "did_not_run", "broke", "todo", "hint"]
MARKS = {"passed": "✓", "library": "≈", "wrong": "✗", "did_not_run": "✗", "broke": "!", "todo": "…",
         "hint": "?"}  # for readers who see no colour  # fmt: skip
COLOURS = {"passed": "#009E73", "library": "#0072B2", "wrong": "#D55E00", "did_not_run": "#D55E00",
           "broke": "#777777", "todo": "#777777", "hint": "#0072B2"}  # fmt: skip


@dataclass(frozen=True)
class Verdict:
    """What a check says."""

    kind: Kind
    sentence: str
    details: tuple[str, ...] = ()  # one line each, shown unchanged: numbers, code
    footer: str = ""
    mistake: Mistake | None = None  # the exercise's mistake that the answer makes, if it is a known one

    @property
    def passed(self) -> bool:
        """Is it right, and the student's own?"""
        return self.kind == "passed"

    @property
    def is_right(self) -> bool:
        return self.kind in ("passed", "library")

    def __repr__(self) -> str:
        lines = [f"{MARKS[self.kind]} {self.sentence}", *(f"    {line}" for line in self.details), self.footer]
        return printable("\n".join(line for line in lines if line))

    def _repr_mimebundle_(self, include=None, exclude=None) -> dict[str, str]:
        numbers = joined(html("<div>{}</div>", line) for line in self.details)
        if numbers:
            style = "margin: 6px 0 0; font-family: monospace; white-space: pre-wrap; overflow-wrap: anywhere"
            numbers = html('<div style="{}">{}</div>', style, numbers)
        footer = html('<div style="margin-top: 6px; opacity: 0.8">{}</div>', marked(self.footer)) if self.footer else ""
        box = f"border-left: 4px solid {COLOURS[self.kind]}; padding: 4px 12px; max-width: 800px; line-height: 1.45"
        text = html("{} {}{}{}", MARKS[self.kind], marked(self.sentence), numbers, footer)
        return {"text/html": str(html('<div role="status" style="{}">{}</div>', box, text)), "text/plain": repr(self)}


def marked(sentence: str) -> Markup:
    """HTML of a sentence in which `backticks` mark code and *asterisks* an emphasised word."""
    parts = sentence.split("`")
    if len(parts) % 2 == 0:  # a backtick without a partner is left as it is
        return html("{}", sentence)
    return joined(html("<code>{}</code>", part) if i % 2 else _emphasised(part) for i, part in enumerate(parts))


def _emphasised(words: str) -> Markup:
    parts = re.split(r"\*(\w+)\*", words)
    return joined(html("<em>{}</em>", part) if i % 2 else part for i, part in enumerate(parts))
