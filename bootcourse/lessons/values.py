"""Answers as plain numbers, so that tensors, arrays and numbers can be compared and printed in one way.

`plain` makes a copy, so that nothing a student's function does later changes its answer.
"""

from dataclasses import dataclass

import numpy as np

NUMERIC = ("tensor", "array", "number")


@dataclass(frozen=True)
class Plain:
    """kind: tensor, array, number, text, tuple, or for everything else the name of its type."""

    kind: str
    data: object = None  # a float64 array, a str, a tuple of Plain, or nothing

    @property
    def shape(self) -> tuple:
        return self.data.shape if self.kind in NUMERIC else ()

    @property
    def words(self) -> str:
        """Its kind, to put into a sentence."""
        if self.kind == "tuple":
            return f"{len(self.data)} values"
        known = {"tensor": "a torch tensor", "array": "a NumPy array", "number": "a number", "text": "a text"}
        return known.get(self.kind, f"an object of type {self.kind}")


def plain(value) -> Plain:
    """A copy of the value as a `Plain`."""
    name = type(value).__name__
    if isinstance(value, str):
        return Plain("text", str(value))
    if isinstance(value, tuple):
        return Plain("tuple", tuple(plain(part) for part in value))
    if isinstance(value, (bool, int, float, np.number, np.bool_)):
        kind = "number"
    elif isinstance(value, np.ndarray):
        kind = "array"
    elif type(value).__module__.partition(".")[0] == "torch" and hasattr(value, "detach"):
        kind, value = "tensor", value.detach().cpu().numpy()
    else:
        return Plain(name)
    if np.asarray(value).dtype.kind not in "biuf":  # complex numbers, objects, texts
        return Plain(f"{name} of {np.asarray(value).dtype}")
    return Plain(kind, np.array(value, dtype=np.float64))


def like(answer: Plain, right: Plain) -> bool:
    """Is it of the right kind? A number and a tensor or an array that holds one number count as the same kind."""
    if right.kind == "tuple":
        same_length = answer.kind == "tuple" and len(answer.data) == len(right.data)
        return same_length and all(map(like, answer.data, right.data))
    single = all(value.kind in NUMERIC and value.shape == () for value in (answer, right))
    return answer.kind == right.kind or single


def same_shape(answer: Plain, right: Plain) -> bool:
    if right.kind == "tuple":
        return all(map(same_shape, answer.data, right.data))
    return answer.shape == right.shape


def same(answer: Plain, right: Plain, tolerance: float = 0.0, nan_too: bool = False) -> bool:
    """Equal in kind, shape and value. tolerance: relative; nan_too: NaN equals NaN."""
    if not (like(answer, right) and same_shape(answer, right)):
        return False
    if right.kind == "tuple":
        return all(same(a, r, tolerance, nan_too) for a, r in zip(answer.data, right.data, strict=True))
    if right.kind in NUMERIC:
        return np.allclose(answer.data, right.data, rtol=tolerance, atol=tolerance / 100, equal_nan=nan_too)
    return answer.data == right.data


def has_nan(value: Plain) -> bool:
    if value.kind == "tuple":
        return any(map(has_nan, value.data))
    return value.kind in NUMERIC and bool(np.isnan(value.data).any())


def shape_words(value: Plain) -> str:
    """The shape, in a sentence; a tuple has several."""
    if value.kind == "tuple":
        return " and ".join(map(shape_words, value.data))
    return str(value.shape)


def numbers(value: Plain, longest: int = 36) -> str:
    """The value in one line; of a value with more than `longest` numbers the shape."""
    if value.kind == "tuple":
        return ", ".join(numbers(part, longest) for part in value.data)
    if value.kind == "text":
        return repr(value.data)
    if value.kind not in NUMERIC:
        return value.words
    if value.data.size > longest:
        return f"{value.words} of shape {value.shape}"
    if value.shape == ():
        return f"{float(value.data):.6g}"
    return np.array2string(value.data, separator=", ", max_line_width=10_000, formatter={"all": "{:.4g}".format})


def first_difference(answer: Plain, right: Plain, tolerance: float) -> tuple[int, ...] | None:
    """The index of the first difference between two arrays of one shape; None for numbers, texts and tuples."""
    if right.kind not in ("tensor", "array") or right.shape == ():
        return None
    close = np.isclose(answer.data, right.data, rtol=tolerance, atol=tolerance / 100)
    return tuple(int(i) for i in np.argwhere(~close)[0])
