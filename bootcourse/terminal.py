"""Text for terminals that cannot show every letter, such as Windows' cp1252 or plain ASCII."""

import codecs
import sys
import unicodedata

LIKE = {"–": "-", "—": "-", "−": "-", "…": "...", "“": '"', "”": '"', "’": "'", "×": "x"}


def spell(error: UnicodeError) -> tuple[str, int]:
    """What stands for letters that an encoding lacks: of Greek ones the name, of others what is like them, or "?"."""
    spelt = []
    for letter in error.object[error.start : error.end]:
        name = unicodedata.name(letter, "").split()
        spelt.append(name[-1].lower() if name[:1] == ["GREEK"] else LIKE.get(letter, "?"))
    return "".join(spelt), error.end


SPELL = "spell"  # its name, for the `errors` of a stream
codecs.register_error(SPELL, spell)


def printable(text: str) -> str:
    """The text as this terminal can print it: the same where it can show all letters, as a notebook can."""
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    return text.encode(encoding, SPELL).decode(encoding)
