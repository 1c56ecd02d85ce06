"""Answers as plain numbers, so that tensors, arrays and numbers can be compared and printed in one way.

`plain` makes a copy, so that nothing a student's function does later changes its answer. `as_json` and `from_json`
carry it from one process to another.
"""

from dataclasses import dataclass

import numpy as np

NUMERIC, SEVERAL = ("tensor", "array", "number"), ("tuple", "list")
LARGEST = 2**20  # numbers in an array that is compared
MOST = 10**308  # about the largest number that a float holds


@dataclass(frozen=True)
class Plain:
    """kind: tensor, array, number, text, tuple, list, or for everything else the name of its type."""

    kind: str
    data: object = None  # an array of float64 or bool, a str, a tuple of Plain, or nothing

    @property
    def shape(self) -> tuple:
        return self.data.shape if self.kind in NUMERIC else ()

    @property
    def words(self) -> str:
        """Its kind, to put into a sentence."""
        if self.kind == "tuple":
            return f"{len(self.data)} value{'s' * (len(self.data) != 1)}"
        if self.kind == "list":
            return f"a list of {len(self.data)}"
        known = {"tensor": "a torch tensor", "array": "a NumPy array", "number": "a number", "text": "a text"}
        return known.get(self.kind, f"an object of type {self.kind}")


def plain(value) -> Plain:
    """A copy of the value as a `Plain`."""
    name = type(value).__name__[:80]
    if isinstance(value, str):
        return Plain("text", str(value))
    if isinstance(value, (tuple, list)):
        return Plain("tuple" if isinstance(value, tuple) else "list", tuple(map(plain, value)))
    if isinstance(value, (bool, int, float, np.number, np.bool_)):
        kind = "number"
    elif isinstance(value, np.ndarray):
        kind = "array"
    elif type(value).__module__.partition(".")[0] == "torch" and hasattr(value, "detach"):
        kind, value = "tensor", value.detach().cpu().numpy()
    else:
        return Plain(name)
    if isinstance(value, int) and abs(value) > MOST:
        value = float("inf") if value > 0 else -float("inf")
    array = np.asarray(value)
    if array.dtype.kind not in "biuf":  # complex numbers, objects, texts
        return Plain(f"{name} of {array.dtype}")
    if array.size > LARGEST:
        return Plain(f"{name} of {array.size:,} numbers")
    return Plain(kind, np.array(array, dtype=bool if array.dtype.kind == "b" else np.float64))


def as_json(value: Plain) -> list:
    """What `from_json` reads: [kind, text or None], [kind, parts], or [kind, is it bool?, shape, numbers]."""
    if value.kind in SEVERAL:
        return [value.kind, list(map(as_json, value.data))]
    if value.kind in NUMERIC:
        return [value.kind, value.data.dtype == bool, value.shape, value.data.ravel().tolist()]
    return [value.kind, value.data]


def from_json(value: list) -> Plain:
    """The Plain again. Raises ValueError or TypeError for what `as_json` did not write."""
    match value:
        case [str() as kind, list() as parts] if kind in SEVERAL:
            return Plain(kind, tuple(map(from_json, parts)))
        case [str() as kind, bool() as truth, list() as shape, list() as flat] if kind in NUMERIC:
            return Plain(kind, np.array(flat, dtype=bool if truth else np.float64).reshape(shape))
        case [str() as kind, None | str() as text] if kind not in (*NUMERIC, *SEVERAL):
            return Plain(kind, text)
    raise ValueError(f"This is no answer: {str(value)[:80]}")


def fitted(answer: Plain, right: Plain) -> Plain:
    """The answer in the form of the right one, where only the form differs: a list for an array, an array for a tuple.

    What has to be a tensor stays as it is: training needs the tensor itself.
    """
    if right.kind == "array" and answer.kind in SEVERAL:
        parts = [fitted(part, right) for part in answer.data]
        if parts and all(part.kind in NUMERIC and part.shape == parts[0].shape for part in parts):
            return Plain("array", np.array([part.data for part in parts]))
    if right.kind == "array" and answer.kind == "tensor":
        return Plain("array", answer.data)
    if right.kind == "tuple":
        if answer.kind in ("array", "tensor") and len(answer.shape) > 0:
            answer = Plain("tuple", tuple(Plain(answer.kind, part) for part in answer.data))
        if answer.kind in SEVERAL and len(answer.data) == len(right.data):
            return Plain("tuple", tuple(map(fitted, answer.data, right.data)))
    return answer


def like(answer: Plain, right: Plain) -> bool:
    """Is it of the right kind? A number and a tensor or an array that holds one number count as the same kind."""
    if right.kind in SEVERAL:
        same_length = answer.kind == right.kind and len(answer.data) == len(right.data)
        return same_length and all(map(like, answer.data, right.data))
    single = all(value.kind in NUMERIC and value.shape == () for value in (answer, right))
    return answer.kind == right.kind or single


def same_shape(answer: Plain, right: Plain) -> bool:
    if right.kind in SEVERAL:
        return all(map(same_shape, answer.data, right.data))
    return answer.shape == right.shape


def absolute(tolerance: float, right: Plain) -> float:
    """The absolute tolerance that belongs to a relative one. A tensor is float32, so its sums are rounded earlier."""
    return tolerance / (10 if right.kind == "tensor" else 100)


def same(answer: Plain, right: Plain, tolerance: float = 0.0, nan_too: bool = False) -> bool:
    """Equal in kind, shape and value. tolerance: relative; nan_too: NaN equals NaN."""
    if not (like(answer, right) and same_shape(answer, right)):
        return False
    if right.kind in SEVERAL:
        return all(same(a, r, tolerance, nan_too) for a, r in zip(answer.data, right.data, strict=True))
    if right.kind not in NUMERIC:
        return answer.data == right.data
    if tolerance == 0:  # np.allclose takes more than twice as long
        alike = nan_too and answer.data.tobytes() == right.data.tobytes()  # a fifth of the time of the next line
        return alike or np.array_equal(answer.data, right.data, equal_nan=nan_too)
    atol = absolute(tolerance, right)
    return np.allclose(answer.data, right.data, rtol=tolerance, atol=atol, equal_nan=nan_too)


def has_nan(value: Plain) -> bool:
    if value.kind in SEVERAL:
        return any(map(has_nan, value.data))
    return value.kind in NUMERIC and bool(np.isnan(value.data).any())


def shape_words(value: Plain) -> str:
    """The shape, in a sentence; a tuple has several."""
    return " and ".join(map(shape_words, value.data)) if value.kind in SEVERAL else str(value.shape)


def numbers(value: Plain, longest: int = 36) -> str:
    """The value in one line; of a value with more than `longest` numbers the shape."""
    if value.kind in SEVERAL:
        return ", ".join(numbers(part, longest) for part in value.data)
    if value.kind == "text":
        return repr(value.data)
    if value.kind not in NUMERIC:
        return value.words
    if value.data.size > longest:
        return f"{value.words} of shape {value.shape}"
    if value.data.dtype == bool:
        return str(value.data.tolist())
    if value.shape == ():
        return f"{float(value.data):.6g}"
    return np.array2string(value.data, separator=", ", max_line_width=10_000, formatter={"all": "{:.4g}".format})


def first_difference(answer: Plain, right: Plain, tolerance: float) -> tuple[int, ...] | None:
    """The index of the first difference between two arrays of one shape; None for numbers, texts and tuples."""
    if right.kind not in ("tensor", "array") or right.shape == ():
        return None
    close = np.isclose(answer.data, right.data, rtol=tolerance, atol=absolute(tolerance, right))
    return tuple(int(i) for i in np.argwhere(~close)[0])
