# SPDX-License-Identifier: MIT
"""What the dataclasses of this package have in common: equality of arrays, and a table in notebooks."""
import dataclasses
import html
from typing import Any

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


class Record:
    """Base of the dataclasses."""

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        fields = dataclasses.fields(self)
        return all(same(getattr(self, field.name), getattr(other, field.name)) for field in fields)

    __hash__ = None  # type: ignore[assignment]

    def _repr_html_(self) -> str:
        rows = [
            f"<tr><th style='text-align:left'>{html.escape(field.name)}</th>"
            f"<td style='text-align:left'>{html.escape(short(getattr(self, field.name)))}</td></tr>"
            for field in dataclasses.fields(self)
        ]
        return f"<table><caption>fettle.{type(self).__name__}</caption>{''.join(rows)}</table>"
