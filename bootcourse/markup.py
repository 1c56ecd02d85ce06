"""The one place where text becomes HTML.

Markup is text that is HTML already; `html` puts values into a template and escapes each that is not. Text from a file
or from a student's answer needs no other escaping, because every page is made with these functions.
"""

from collections.abc import Iterable

from markupsafe import Markup

__all__ = ["Markup", "html", "joined"]


def html(template: str, *values, **named) -> Markup:
    """A template of ours, as `str.format` fills it, with every value escaped that is not Markup."""
    return Markup(template).format(*values, **named)


def joined(parts: Iterable, between: str = "") -> Markup:
    """Parts one after the other, with every part escaped that is not Markup. between: HTML of ours."""
    return Markup(between).join(parts)
