# SPDX-License-Identifier: MIT
"""What the dataclasses of this package have in common: equality of arrays, members that are known, and a table in notebooks."""
import dataclasses
import difflib
import html
from typing import Any, Iterable, Sequence, Tuple

import numpy as np


def same(a: Any, b: Any) -> bool:
    """Equal, arrays by their numbers; NaN equals NaN."""
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return bool(np.array_equal(np.asarray(a, float), np.asarray(b, float), equal_nan=True))
    if isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)):
        return len(a) == len(b) and all(same(x, y) for x, y in zip(a, b))
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    return bool(a == b) or (a != a and b != b)


def short(value: Any) -> str:
    """One line for a table."""
    if isinstance(value, np.ndarray) and value.size > 12:
        return f"array of shape {value.shape}"
    if isinstance(value, (list, tuple)) and len(value) > 12:
        return f"{len(value)} entries"
    if dataclasses.is_dataclass(value):
        return f"{type(value).__name__} {getattr(value, 'name', '')}".rstrip()
    if isinstance(value, (list, tuple)):
        return ", ".join(short(entry) for entry in value)
    if isinstance(value, float):
        return f"{value:.6g}"
    return str(value)


def did_you_mean(word: str, known: Sequence[str]) -> str:
    """The end of a message about an unknown word."""
    nearest = difflib.get_close_matches(word, known, 1)
    return f"did you mean {nearest[0]!r}?" if nearest else f"there are {', '.join(known)}"


def table(title: str, rows: Iterable[Tuple[str, Any]]) -> str:
    """Names and values, for notebooks."""
    lines = [
        f"<tr><th style='text-align:left'>{html.escape(name)}</th><td style='text-align:left'>{html.escape(short(value))}</td></tr>"
        for name, value in rows
    ]
    return f"<table><caption>fettle.{title}</caption>{''.join(lines)}</table>"


class Record:
    """Base of the dataclasses, which have slots: a member that is misspelt is an error."""

    __slots__ = ()

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        fields = dataclasses.fields(self)
        return all(same(getattr(self, field.name), getattr(other, field.name)) for field in fields)

    __hash__ = None  # type: ignore[assignment]

    def __setattr__(self, name: str, value: Any) -> None:
        try:
            object.__setattr__(self, name, value)
        except AttributeError as fault:
            known = [field.name for field in dataclasses.fields(self)]
            raise AttributeError(f"{type(self).__name__} has no member {name!r}; {did_you_mean(name, known)}") from fault

    def _repr_html_(self) -> str:
        return table(type(self).__name__, [(field.name, getattr(self, field.name)) for field in dataclasses.fields(self)])
