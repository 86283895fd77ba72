# SPDX-License-Identifier: MIT
"""What functions of the compiled module are given and cannot take, in fettle's words: which argument, what came, what is allowed."""
import functools
import re
from typing import Any, Callable, Dict, List, Tuple, TypeVar

from . import _fettle
from ._record import did_you_mean
from .errors import Error, Fault

F = TypeVar("F", bound=Callable[..., Any])
REFUSED = "(): incompatible function arguments"  # pybind11's words
GREATEST = 2**31 - 1
ALLOWED = {
    "int": "a whole number",
    "float": "a number",
    "bool": "True or False",
    "str": "a text",
    "os.PathLike": "a path, str or os.PathLike,",
    "Callable": "a function",
    "List": "a list",
}


def parameters_of(message: str) -> Dict[str, Tuple[str, bool]]:
    """For each parameter that pybind11's message names: its type, and whether it may be left out."""
    found = re.search(r"^ *1\. \((.*)\) -> ", message, re.MULTILINE)
    parts, depth = [""], 0
    for character in found.group(1) if found else "":
        depth += (character in "[({") - (character in "])}")
        if character == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += character
    parameters = {}
    for part in parts:
        name, colon, rest = part.strip().partition(": ")
        if colon:
            kind, has_default, _ = rest.partition(" = ")
            parameters[name] = (kind, bool(has_default))
    return parameters


def takes(kind: str, value: Any) -> bool:
    """Could a parameter of that type take it? True where that is not known."""
    if kind.startswith("Optional["):
        return value is None or takes(kind[len("Optional[") : -1], value)
    if kind.startswith("fettle._fettle."):
        wanted = getattr(_fettle, kind.rsplit(".", 1)[1], None)
        return wanted is None or isinstance(value, wanted)
    if kind == "int":
        return hasattr(value, "__index__") and -GREATEST - 1 <= value.__index__() <= GREATEST
    if kind == "float":
        return hasattr(value, "__float__") or hasattr(value, "__index__")
    if kind == "bool":
        return isinstance(value, bool)
    if kind == "str":
        return isinstance(value, (str, bytes))
    if kind == "os.PathLike":
        return isinstance(value, (str, bytes)) or hasattr(value, "__fspath__")
    if kind.startswith("Callable"):
        return callable(value)
    if kind.startswith("List["):
        element = kind[len("List[") : -1]
        return not isinstance(value, (str, bytes)) and hasattr(value, "__iter__") and all(takes(element, each) for each in value)
    return True


def allowed(kind: str) -> str:
    if kind.startswith("Optional["):
        return f"{allowed(kind[len('Optional['):-1]).rstrip(',')}, or None,"
    if kind.startswith("fettle._fettle."):
        return f"a fettle.{kind.rsplit('.', 1)[1]}"
    return ALLOWED.get(kind.split("[")[0], kind)


def shown(value: Any) -> str:
    text = repr(value)
    return "None" if value is None else f"{'a value' if len(text) > 60 else text + ','} of type {type(value).__name__}"


def faults_of(message: str, given: Tuple[Any, ...], named: Dict[str, Any]) -> List[Fault]:
    """The faults of a call that pybind11 has refused with that message."""
    parameters = parameters_of(message)
    function = message.partition("(")[0]
    faults = []
    if len(given) > len(parameters):
        faults.append(Fault("unknown_key", function, f"takes at most {len(parameters)} arguments; {len(given)} were given"))
    values = {**dict(zip(parameters, given)), **named}
    for name, value in values.items():
        if name not in parameters:
            faults.append(Fault("unknown_key", function, f"there is no argument {name!r}; {did_you_mean(name, list(parameters))}"))
            continue
        kind = parameters[name][0]
        if takes(kind, value):
            continue
        if isinstance(value, int) and "int" in (kind, kind[len("Optional[") : -1]):
            faults.append(Fault("out_of_range", name, f"{value} is not allowed: {-GREATEST - 1} to {GREATEST} is"))
        else:
            faults.append(Fault("wrong_type", name, f"{shown(value)}: {allowed(kind)} is expected".replace(", is", " is")))
    for name, (kind, optional) in parameters.items():
        if name not in values and not optional:
            faults.append(Fault("missing_key", name, f"is missing: {allowed(kind)} is expected".replace(", is", " is")))
    if not faults:
        wanted = ", ".join(f"{name}: {kind}" for name, (kind, _) in parameters.items())
        faults.append(Fault("wrong_type", function, f"these arguments do not fit; expected are ({wanted})"))
    return faults


def in_plain_words(function: F) -> F:
    """It, with errors that name the argument. In `fettle`, where it is found under its name."""

    @functools.wraps(function)
    def call(*given: Any, **named: Any) -> Any:
        try:
            return function(*given, **named)
        except TypeError as error:
            if not str(error).startswith(function.__name__ + REFUSED):
                raise
            faults = faults_of(str(error), given, named)
        raise Error(faults)

    call.__module__, call.__qualname__ = "fettle", function.__name__
    return call  # type: ignore[return-value]
