# SPDX-License-Identifier: MIT
"""Errors in what was given, and designs that cannot be evaluated."""
import dataclasses
from typing import List, Sequence


@dataclasses.dataclass
class Fault:
    """One thing that is wrong: `code` as in docs/interface.md, `where` a file and JSON pointer, a body, a mesh and an element."""

    code: str
    where: str
    message: str


class Error(ValueError):
    """What was given cannot be used: `errors` has every fault that was found. Shapes raise it, or ValueError, to refuse dimensions."""

    def __init__(self, errors: Sequence[Fault]):
        super().__init__(errors)
        self.errors: List[Fault] = list(errors)

    @property
    def code(self) -> str:
        """Code of the first fault."""
        return self.errors[0].code

    @property
    def where(self) -> str:
        """Place of the first fault."""
        return self.errors[0].where

    def __str__(self) -> str:
        return "\n".join(f"{e.where}: {e.message}" if e.where else e.message for e in self.errors)


class EvaluationError(RuntimeError):
    """There is no design at these parameters: parts that cannot be made, that intersect, a motion that is blocked. str() says which, and
    so do `errors`, as those of Error do."""

    def __init__(self, reason: str):
        super().__init__(reason)
        self.errors: List[Fault] = [Fault("inconsistent", "design", reason)]

    @property
    def code(self) -> str:
        """Code of the first fault."""
        return self.errors[0].code

    @property
    def where(self) -> str:
        """Place of the first fault."""
        return self.errors[0].where
