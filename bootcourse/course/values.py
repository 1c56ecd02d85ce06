"""Answers as plain numbers, so that tensors, arrays and numbers can be compared, printed and sent in one way."""

from __future__ import annotations

import array
import io
import itertools
from collections import deque
from collections.abc import Iterator, MappingView, Sized
from decimal import Decimal
from numbers import Rational

import msgspec
import numpy as np

NUMERIC, SEVERAL = ("tensor", "array", "number"), ("tuple", "list")
LIKE_A_LIST = (list, range, deque, array.array, Iterator, MappingView)  # a generator is an Iterator
LARGEST = 2**20  # numbers in an array that is compared
MANY, DEEPEST = 2**16, 8  # values in a list with all lists in it, and lists in each other


class Plain(msgspec.Struct, frozen=True, eq=False):
    """kind: tensor, array, number, text, tuple, list, or for everything else the name of its type."""

    kind: str
    array: np.ndarray | None = None  # of float64 or bool, for the numeric kinds
    parts: tuple[Plain, ...] | None = None  # of a tuple or a list
    text: str | None = None

    def __post_init__(self):
        fields = (self.array is None, self.parts is None)
        if fields != (self.kind not in NUMERIC, self.kind not in SEVERAL):
            raise ValueError(f"'{self.kind}' does not hold this.")  # only a forged message can say so

    @property
    def data(self) -> np.ndarray | tuple[Plain, ...] | str | None:
        """Numbers, parts or text; None for an object of another type."""
        return self.array if self.kind in NUMERIC else self.parts if self.kind in SEVERAL else self.text

    @property
    def shape(self) -> tuple:
        return self.array.shape if self.kind in NUMERIC else ()

    @property
    def words(self) -> str:
        """Its kind, to put into a sentence."""
        if self.kind == "tuple":
            return f"{len(self.parts)} value{'s' * (len(self.parts) != 1)}"
        if self.kind == "list":
            return f"a list of {len(self.parts)}"
        known = {"tensor": "a torch tensor", "array": "a NumPy array", "number": "a number", "text": "a text"}
        return known.get(self.kind, f"an object of type {self.kind}")


def plain(value) -> Plain:
    """A copy of the value as a `Plain`: nothing that a student's function does later changes it."""
    return copied(value, DEEPEST, itertools.count(1))


def copied(value, deeper: int, count: Iterator[int]) -> Plain:
    """`plain` of a value that may hold lists to a depth of `deeper`. count: numbers all values that are in a list."""
    if type(value) in (float, int, bool):  # most of what stands in a list
        return Plain("number", np.array(as_float(value)))
    name = sendable(type(value).__name__)[:80]
    if isinstance(value, str):
        return Plain("text", text=sendable(str.__str__(value)))
    if isinstance(value, (tuple, *LIKE_A_LIST)) and not isinstance(value, io.IOBase):
        if deeper == 0:
            return Plain(f"{name} with more than {DEEPEST} lists in each other")
        many, parts = Plain(f"{name} of more than {MANY:,} values"), []
        if isinstance(value, Sized) and len(value) > MANY:
            return many
        for part in value:
            parts.append(copied(part, deeper - 1, count))
            if next(count) > MANY:
                return many
        return Plain("tuple" if isinstance(value, tuple) else "list", parts=tuple(parts))
    if isinstance(value, (bool, int, float, np.number, np.bool_, Rational, Decimal)):
        kind, value = "number", as_float(value)
    elif isinstance(value, np.ndarray):
        kind = "array"
    elif type(value).__module__.partition(".")[0] == "torch" and hasattr(value, "detach"):
        kind, value = "tensor", as_array(value)
    else:
        return Plain(name if name not in (*NUMERIC, *SEVERAL, "text") else f"{name} of yours")
    numbers = np.asarray(value)
    if numbers.dtype.kind not in "biuf":  # complex numbers, objects, texts
        return Plain(f"{name} of {numbers.dtype}")
    if numbers.size > LARGEST:
        return Plain(f"{name} of {numbers.size:,} numbers")
    return Plain(kind, np.array(numbers, dtype=bool if numbers.dtype.kind == "b" else np.float64))


def as_float(number):
    """A number of exact arithmetic as a float, infinite where no float is as large; others as they are."""
    if isinstance(number, (bool, float, np.generic)):
        return number
    try:
        return float(number)
    except OverflowError:
        return float("inf") if number > 0 else -float("inf")
    except ValueError:  # a signalling NaN of `decimal`
        return float("nan")


def as_array(tensor) -> np.ndarray:
    """The numbers of a torch tensor; where it has none (it is quantised, or on no device), an array of its type's name.

    Sparse tensors, and those in bfloat16, which NumPy does not know, have numbers, too.
    """
    try:
        dense = tensor.detach().to_dense().cpu().resolve_conj().resolve_neg()
        return (dense.double() if dense.is_floating_point() else dense).numpy()
    except (RuntimeError, TypeError, AttributeError):  # NotImplementedError is a RuntimeError
        return np.array(str(tensor.dtype))


def sendable(text: str) -> str:
    """The text, with half characters written out: no message can hold them."""
    return text.encode("utf-8", "backslashreplace").decode()


def encode_array(array: np.ndarray) -> tuple[bool, tuple, bytes]:
    """For msgspec: is it of truth values?, its shape, its numbers."""
    return array.dtype == bool, array.shape, array.tobytes()


def decode_array(_: type, sent: tuple) -> np.ndarray:
    """The array again. Raises ValueError or TypeError for what `encode_array` did not write."""
    truth, shape, numbers = sent
    return np.frombuffer(numbers, bool if truth else np.float64).reshape(shape)


# Comparison -------------------------------------------------------------------------------------------


def fitted(answer: Plain, right: Plain) -> Plain:
    """The answer in the form of the right one, where only the form differs: a list for an array, an array for a tuple.

    What has to be a tensor stays as it is: training needs the tensor itself.
    """
    if right.kind == "array" and answer.kind in SEVERAL:
        parts = [fitted(part, right) for part in answer.parts]
        if parts and all(part.kind in NUMERIC and part.shape == parts[0].shape for part in parts):
            return Plain("array", np.array([part.array for part in parts]))
        if not parts and right.shape[:1] == (0,):
            return Plain("array", np.empty(right.shape))
    if right.kind == "array" and answer.kind == "tensor":
        return Plain("array", answer.array)
    if right.kind in SEVERAL:
        if answer.kind in ("array", "tensor") and answer.shape[:1] == (len(right.parts),):
            answer = Plain("tuple", parts=tuple(Plain(answer.kind, np.asarray(part)) for part in answer.array))
        if answer.kind in SEVERAL and len(answer.parts) == len(right.parts):
            return Plain(right.kind, parts=tuple(map(fitted, answer.parts, right.parts)))
    return answer


def like(answer: Plain, right: Plain) -> bool:
    """Is it of the right kind? A number and a tensor or an array that holds one number count as the same kind."""
    if right.kind in SEVERAL:
        same_length = answer.kind == right.kind and len(answer.parts) == len(right.parts)
        return same_length and all(map(like, answer.parts, right.parts))
    single = all(value.kind in NUMERIC and value.shape == () for value in (answer, right))
    return answer.kind == right.kind or single


def same_shape(answer: Plain, right: Plain) -> bool:
    if right.kind in SEVERAL:
        return all(map(same_shape, answer.parts, right.parts))
    return answer.shape == right.shape


def close(answer: Plain, right: Plain, tolerance: float, nan_too: bool = False) -> np.ndarray:
    """Which numbers agree. tolerance: relative; its absolute one is larger for a tensor, whose sums are float32."""
    absolute = tolerance / (10 if right.kind == "tensor" else 100)
    if answer.shape == right.shape == () and np.isfinite(right.array):  # most are: a tenth of NumPy's time
        one, other = float(answer.array), float(right.array)
        return np.array(abs(one - other) <= absolute + tolerance * abs(other))
    return np.isclose(answer.array, right.array, rtol=tolerance, atol=absolute, equal_nan=nan_too)


def same(answer: Plain, right: Plain, tolerance: float = 0.0, nan_too: bool = False) -> bool:
    """Equal in kind, shape and value. tolerance: relative; nan_too: NaN equals NaN."""
    if not (like(answer, right) and same_shape(answer, right)):
        return False
    if right.kind in SEVERAL:
        return all(same(a, r, tolerance, nan_too) for a, r in zip(answer.parts, right.parts, strict=True))
    if right.kind not in NUMERIC:
        return answer.text == right.text
    if nan_too and answer.array.tobytes() == right.array.tobytes():  # a fifth of the time of what follows
        return True
    return bool(close(answer, right, tolerance, nan_too).all())


def has_nan(value: Plain) -> bool:
    if value.kind in SEVERAL:
        return any(map(has_nan, value.parts))
    return value.kind in NUMERIC and bool(np.isnan(value.array).any())


# Words ------------------------------------------------------------------------------------------------


def shape_words(value: Plain) -> str:
    """The shape, in a sentence; a tuple has several."""
    return " and ".join(map(shape_words, value.parts)) if value.kind in SEVERAL else str(value.shape)


def numbers(value: Plain, longest: int = 36) -> str:
    """The value in one line; of a value with more than `longest` numbers the shape."""
    if value.kind in SEVERAL:
        return ", ".join(numbers(part, longest) for part in value.parts)
    if value.kind == "text":
        return repr(value.text)
    if value.kind not in NUMERIC:
        return value.words
    if value.array.size > longest:
        return f"{value.words} of shape {value.shape}"
    if value.array.dtype == bool:
        return str(value.array.tolist())
    if value.shape == ():
        return f"{float(value.array):.6g}"
    return np.array2string(value.array, separator=", ", max_line_width=10_000, formatter={"all": "{:.4g}".format})
