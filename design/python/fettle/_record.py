# SPDX-License-Identifier: MIT
"""What the dataclasses of this package have in common: known members, numbers with units, equality of arrays, few lines of text."""
import dataclasses
import difflib
import functools
import html
import re
import textwrap
from typing import TYPE_CHECKING, Any, Dict, Iterable, List, Mapping, Sequence, Tuple, TypeVar

import numpy as np

from . import _fettle
from .errors import Fault

T = TypeVar("T")

if TYPE_CHECKING:
    #: A number in SI once it is there; it may be given with a unit, as a text: "0.3mm".
    Number = Any
else:
    Number = float

MOST_LINES = 10  # of a repr
COLUMNS = 120
MOST_ROWS = 20  # of a table of records
LEFT = "style='text-align:left'"


def same(a: Any, b: Any) -> bool:
    """Equal, arrays by their numbers; NaN equals NaN."""
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return bool(np.array_equal(np.asarray(a, float), np.asarray(b, float), equal_nan=True))
    if isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)):
        return len(a) == len(b) and all(same(x, y) for x, y in zip(a, b))
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    return bool(a == b) or (a != a and b != b)


def did_you_mean(word: str, known: Sequence[str]) -> str:
    """The end of a message about an unknown word."""
    nearest = difflib.get_close_matches(word, known, 1)
    return f"did you mean {nearest[0]!r}?" if nearest else f"there are {', '.join(known)}"


class Given(float):
    """A number that was given with a unit, where only the whole record determines its dimension."""

    __slots__ = ("dimension",)
    dimension: str

    def __reduce__(self) -> Tuple[Any, ...]:
        return given, (float(self), self.dimension)


def given(si: float, dimension: str) -> Given:
    """It, of that dimension."""
    made = Given(si)
    made.dimension = dimension
    return made


@functools.lru_cache(maxsize=None)
def units() -> Mapping[str, str]:
    """Their dimensions."""
    return _fettle.units()


def _number(text: str, dimension: str, where: str) -> float:
    """The SI value of a text with a unit; dimension "any": the unit determines it."""
    if dimension != "any":
        return _fettle.parse_quantity(text, dimension, where)
    unit = re.sub(r"^\s*[-+.\d]*([eE][-+]?\d+)?\s*", "", text).strip()
    dimension = units().get(unit, "number")
    return given(_fettle.parse_quantity(text, dimension, where), dimension)


def in_si(value: Any, dimension: str, where: str) -> Any:
    """Texts with units as numbers, in lists and tables too; all else as it is."""
    if isinstance(value, str):
        return _number(value, dimension, where)
    if isinstance(value, (list, tuple)):
        return type(value)(in_si(each, dimension, where) for each in value) if _has_text(value) else value
    if isinstance(value, dict):
        return {name: in_si(each, dimension, f"{where}/{name}") for name, each in value.items()} if _has_text(value.values()) else value
    return value


def _has_text(values: Iterable[Any]) -> bool:
    return any(isinstance(value, (str, list, tuple)) for value in values)


def number(dimension: str, default: Any = dataclasses.MISSING, *, factory: Any = dataclasses.MISSING, of_unit: bool = False) -> Any:
    """A member that numbers with units may be given for. dimension: its own, "any" where the whole record determines it, "unit" where the record's
    `unit` does. of_unit: the name of a unit alone is one of it."""
    metadata = {"dimension": dimension, "of_unit": of_unit}
    if factory is not dataclasses.MISSING:
        return dataclasses.field(default_factory=factory, metadata=metadata)
    if default is not dataclasses.MISSING:
        return dataclasses.field(default=default, metadata=metadata)
    return dataclasses.field(metadata=metadata)


@functools.lru_cache(maxsize=None)
def _numbers(kind: type) -> Dict[str, Mapping[str, Any]]:
    return {field.name: field.metadata for field in dataclasses.fields(kind) if "dimension" in field.metadata}


def faults_of(value: Any, dimension: str, where: str) -> List[Fault]:
    """The faults of numbers whose unit is of another dimension; "" is one that no unit has."""
    if isinstance(value, (list, tuple)):
        return [fault for each in value for fault in faults_of(each, dimension, where)]
    if not isinstance(value, Given) or value.dimension == dimension:
        return []
    wanted = f"{dimension.replace('_', ' ')} is expected" if dimension else "there is no unit for what is wanted; give the number in SI"
    return [Fault("wrong_type", where, f"a unit of {value.dimension.replace('_', ' ')} was given, {wanted}")]


def place(record: Any, member: str) -> str:
    """"body `cube`/density", as errors of the library have it."""
    words = re.sub(r"(?<!^)(?=[A-Z])", " ", type(record).__name__).lower()
    name = getattr(record, "name", "")
    return f"{words} `{name}`/{member}" if isinstance(name, str) and name else f"{words}/{member}"


def short(value: Any) -> str:
    """A part of a line."""
    if isinstance(value, np.ndarray):
        return f"array of shape {value.shape}" if value.size > 12 else str(value.tolist())
    if isinstance(value, Record):
        name = getattr(value, "name", "")
        return f"{type(value).__name__}({name!r})" if name else f"{type(value).__name__}(...)"
    if isinstance(value, (list, tuple)):
        if len(value) > 6:
            return f"{len(value)} entries"
        inside = ", ".join(short(entry) for entry in value)
        return f"({inside})" if isinstance(value, tuple) else f"[{inside}]"
    if isinstance(value, dict):
        inside = ", ".join(f"{name!r}: {short(each)}" for name, each in value.items())
        return f"{len(value)} entries" if len(value) > 6 else f"{{{inside}}}"
    text = repr(value)
    return text if len(text) <= COLUMNS else text[: COLUMNS - 3] + "..."


def few_lines(text: str) -> str:
    """Broken at blanks, and cut off after some lines."""
    lines = textwrap.wrap(text, COLUMNS, subsequent_indent="    ", break_on_hyphens=False)
    return "\n".join(lines if len(lines) <= MOST_LINES else [*lines[: MOST_LINES - 1], "    ..."])


def cell(value: Any) -> str:
    """A cell of a table, as HTML; a record shows its members."""
    if isinstance(value, Record):
        return html.escape(repr(value))
    return value if isinstance(value, str) and not value else html.escape(value if isinstance(value, str) else short(value))


def table(title: str, rows: Iterable[Tuple[str, Any]]) -> str:
    """Names and values, for notebooks."""
    lines = [f"<tr><th {LEFT}>{html.escape(name)}</th><td {LEFT}>{cell(value)}</td></tr>" for name, value in rows]
    return f"<table><caption>fettle.{title}</caption>{''.join(lines)}</table>"


def columns(title: str, names: Sequence[str], rows: Sequence[Sequence[Any]]) -> str:
    """Rows below a head, for notebooks; of many the first."""
    head = "".join(f"<th {LEFT}>{html.escape(name)}</th>" for name in names)
    shown = "".join("<tr>" + "".join(f"<td {LEFT}>{cell(value)}</td>" for value in row) + "</tr>" for row in rows[:MOST_ROWS])
    more = f"<tr><td colspan='{len(names)}'>and {len(rows) - MOST_ROWS} more</td></tr>" if len(rows) > MOST_ROWS else ""
    return f"<table><caption>{html.escape(title)}</caption><tr>{head}</tr>{shown}{more}</table>"


class Record:
    """Base of the dataclasses, which have slots: a member that is misspelt is an error."""

    __slots__ = ()

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        fields = dataclasses.fields(self)
        return all(same(getattr(self, field.name), getattr(other, field.name)) for field in fields)

    __hash__ = None  # type: ignore[assignment]

    # Hidden from type checkers, for whom any name would do where these are.
    if not TYPE_CHECKING:

        def __setattr__(self, name, value):
            if isinstance(value, (str, list, tuple, dict)) and name in _numbers(type(self)):
                value = self._in_si(name, value)
            try:
                object.__setattr__(self, name, value)
            except AttributeError as fault:
                raise AttributeError(self._unknown(name)) from fault

        def __getattr__(self, name):
            raise AttributeError(name if name.startswith("_") else self._unknown(name))

    def _unknown(self, name: str) -> str:
        known = [field.name for field in dataclasses.fields(self)]
        return f"{type(self).__name__} has no member {name!r}; {did_you_mean(name, known)}"

    def _in_si(self, name: str, value: Any) -> Any:
        of = _numbers(type(self))[name]
        if isinstance(value, str) and of["of_unit"] and value in units():
            value = f"1 {value}"
        dimension = of["dimension"]
        if dimension == "unit":
            unit = getattr(self, "unit", None)
            if unit is None:
                return value  # it comes later: __post_init__ asks again
            dimension = units().get(unit, "number")
        return in_si(value, dimension, place(self, name))

    def __repr__(self) -> str:
        members = [f"{field.name}={short(getattr(self, field.name))}" for field in dataclasses.fields(self)]
        return few_lines(f"{type(self).__name__}({', '.join(members)})")

    def _repr_html_(self) -> str:
        fields = dataclasses.fields(self)
        return table(type(self).__name__, [(field.name, getattr(self, field.name)) for field in fields])


class Records(List[T]):
    """A list of records, which shows itself in few lines."""

    def __repr__(self) -> str:
        if not self:
            return "[]"
        if len(self) == 1:
            return f"[{self[0]!r}]"
        kinds = sorted({type(each).__name__ for each in self})
        lines = [textwrap.shorten(repr(each), COLUMNS, placeholder=" ...") for each in self[: MOST_LINES - 2]]
        more = [f"... and {len(self) - len(lines)} more"] if len(self) > len(lines) else []
        return "\n".join([f"{len(self)} {', '.join(kinds)}:", *lines, *more])

    def _repr_html_(self) -> str:
        if not self or len({type(each) for each in self}) != 1 or not dataclasses.is_dataclass(self[0]):
            return f"<pre>{html.escape(repr(self))}</pre>"
        names = [field.name for field in dataclasses.fields(self[0])]
        rows = [[getattr(each, name) for name in names] for each in self[: MOST_ROWS + 1]]
        title = f"{len(self)} {type(self[0]).__name__}"
        return columns(title, names, rows + [[]] * (len(self) - len(rows)))
