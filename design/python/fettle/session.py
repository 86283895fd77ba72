# SPDX-License-Identifier: MIT
"""A design or a scene that is open, as `fettle studio` has it: values are set, and what becomes known of them is told as soon as it is known.
The last values win: what is still computed for former ones ends. A file that is edited meanwhile is read again.

    with fettle.open("hinge.design.json") as session:
        session.set(gap="0.3mm")
        print(session.result())                     # waits for it
        session.pull("stroke", "30mm")              # the nearest values that bring it there, to first order
        for news in session.news(timeout=10):
            print(news.kind, news.revision)
            if news.kind == "settled":
                break
        session.save("wider.design.json")

A notebook shows a session as tables that change while results come.
"""
import dataclasses
import html
import importlib
import math
import os
import sys
import threading
import time
import weakref
from typing import Any, Callable, Dict, Iterator, List, Literal, Mapping, Optional, Sequence, Tuple, TypeVar, Union

from numpy.typing import ArrayLike

from . import _fettle
from ._calls import in_plain_words
from ._record import COLUMNS, MOST_LINES, Record, columns, few_lines
from ._shown import counted, names_of
from .design import Parameter
from .errors import Error, Fault
from .results import DesignEvaluation, Measurement, Pairs
from .scene import PathLike

T = TypeVar("T")
Values = Dict[str, float]  # by parameter, SI
Given = Union[float, str]  # SI, or with a unit

REFRESH_SECONDS = 0.1  # between two looks of a notebook's tables
END_SECONDS = 2  # for these tables to end


def _summary_rows(summary: Dict[str, Any]) -> List[List[str]]:
    return [
        [row["name"], row["asked"], f"{row['now']} {row['unit']}".strip(), row["known"], row["verdict"]] for row in summary.get("rows", [])
    ]


def _summary_text(summary: Dict[str, Any]) -> str:
    return " ".join(filter(None, (summary.get("sentence"), summary.get("why"))))


def _summary_table(title: str, summary: Dict[str, Any]) -> str:
    return columns(title, ["requirement", "asked", "now", "known by", "verdict"], _summary_rows(summary))


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Tuning(Record):
    """How a search stands."""

    runs: bool = False
    evaluations: int = 0
    values: Values = dataclasses.field(default_factory=dict)  #: the best so far; empty: there is none
    objective: float = math.nan  #: there
    violation: float = math.nan
    message: str = ""  #: at the end: the verdict


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Pulled(Record):
    """What was set to bring a quantity to a value."""

    revision: int = 0
    values: Values = dataclasses.field(default_factory=dict)
    predicted: float = math.nan  #: of the quantity, to first order, SI
    reaches: bool = True  #: False: the parameters' bounds are in the way


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class JudgedDesign(Record):
    """A design beside other models of the same motion, and what is proven of it."""

    final: DesignEvaluation = dataclasses.field(default_factory=DesignEvaluation)
    play_taken_up: DesignEvaluation = dataclasses.field(default_factory=DesignEvaluation)  #: not usable: there is no such model
    play_taken_up_by: str = ""  #: that model's name
    play_not_compared: str = ""  #: why there is none though there are fits
    in_doubt: List[str] = dataclasses.field(default_factory=list)  #: requirements that are met as written, and not with the play taken up
    clearance: Pairs = dataclasses.field(default_factory=Pairs)  #: of all clearance constraints, in their order


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class News(Record):
    """What has become known, and of which revision: the number of what was set."""

    #: "opened": the files were read, also again; "faults": they cannot be read any more, and what was open stays (without errors: they can
    #: again); "asked": an evaluation begins; "refused": there is no design at these values; "measured": motion and values;
    #: "differentiated": the derivatives too; "judged": what is proven too; "settled": nothing more will be told of this revision;
    #: "tuning": of a search.
    kind: Literal[
        "opened", "faults", "asked", "progress", "refused", "measured", "differentiated", "judged", "settled", "tuning"
    ] = "asked"
    revision: int = 0
    values: Values = dataclasses.field(default_factory=dict)
    is_as_in_file: bool = True
    can_undo: bool = False
    can_redo: bool = False
    seconds: float = 0.0  #: since the evaluation began
    text: str = ""  #: of "progress": what is done; of "refused": the reason
    step: int = 0  #: of "progress"
    steps: int = 0
    errors: List[Fault] = dataclasses.field(default_factory=list)  #: of "faults"
    parameters: List[Parameter] = dataclasses.field(default_factory=list)  #: of "opened", as the file has them
    warnings: List[str] = dataclasses.field(default_factory=list)  #: of "opened"
    evaluation: Optional[DesignEvaluation] = None  #: from "measured" on
    judged: Optional[JudgedDesign] = None  #: of "judged"
    summary: Dict[str, Any] = dataclasses.field(default_factory=dict)  #: of an evaluation, in words: sentence, why, rows
    tuning: Optional[Tuning] = None  #: of "tuning"


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class SessionResult(Record):
    """All that is known of the values that were set.

    result.met, result.objective, result.requirements["stroke"].value, result.evaluation.gradient, result.judged.clearance
    """

    revision: int = 0
    values: Values = dataclasses.field(default_factory=dict)
    requirements: Dict[str, Measurement] = dataclasses.field(default_factory=dict)  #: by name, SI
    evaluation: DesignEvaluation = dataclasses.field(default_factory=DesignEvaluation)  #: with its gradients
    judged: Optional[JudgedDesign] = None
    summary: Dict[str, Any] = dataclasses.field(default_factory=dict)  #: in words: sentence, why, rows
    seconds: float = 0.0  #: that it took

    @property
    def objective(self) -> float:
        return self.evaluation.objective

    @property
    def met(self) -> bool:
        """Are all requirements met?"""
        return self.evaluation.violation <= 0

    def __repr__(self) -> str:
        lines = [_summary_text(self.summary), *("  ".join(row) for row in _summary_rows(self.summary))]
        more = [f"... and {len(lines) - MOST_LINES + 1} more"] if len(lines) > MOST_LINES else []
        return "\n".join([line[:COLUMNS] for line in lines[: MOST_LINES - len(more)]] + more)

    def _repr_html_(self) -> str:
        return _summary_table(_summary_text(self.summary), self.summary)


class _View:
    """What a notebook shows of a session, as its news tell it."""

    def __init__(self, path: str):
        self.path = path
        self.parameters: List[Parameter] = []
        self.values: Values = {}
        self.summary: Dict[str, Any] = {}
        self.state = ""
        self.faults: List[Fault] = []
        self.tuning: Optional[Tuning] = None
        self.is_stale = True  # is the summary of other values?

    def hear(self, news: News) -> None:
        if news.kind != "tuning":
            self.values = news.values
        if news.kind == "opened":
            self.parameters = news.parameters
        elif news.kind == "faults":
            self.faults = news.errors
        elif news.kind == "asked":
            self.state, self.is_stale = "simulating", True
        elif news.kind == "progress":
            self.state = f"{news.text}: step {news.step} of {news.steps}"
        elif news.kind == "refused":
            self.state, self.is_stale = news.text, True
        elif news.kind == "settled":
            self.state = self.state if self.is_stale else f"done in {news.seconds:.2g} s"
        elif news.kind == "tuning":
            self.tuning = news.tuning
        if news.summary:
            self.state = "differentiating" if news.kind == "measured" else "judging" if news.kind == "differentiated" else self.state
            self.summary, self.is_stale = news.summary, False

    def _parameter_rows(self) -> List[Sequence[Any]]:
        rows: List[Sequence[Any]] = []
        for parameter in self.parameters:
            numbers = (self.values.get(parameter.name, math.nan), parameter.lower, parameter.upper)
            rows.append([parameter.name, *(f"{_fettle.from_si(si, parameter.unit):.6g}" for si in numbers), parameter.unit])
        return rows

    def html(self) -> str:
        lines = [self.path, self.state, *(f"{fault.where}: {fault.message}" for fault in self.faults)]
        if self.tuning is not None:
            state = f"tuning, {self.tuning.evaluations} evaluations" if self.tuning.runs else self.tuning.message
            lines.append(f"{state}; best objective {self.tuning.objective:.6g}" if self.tuning.values else state)
        told = "".join(f"<div>{html.escape(line)}</div>" for line in lines if line)
        parameters = columns("parameters", ["parameter", "value", "lower", "upper", "unit"], self._parameter_rows())
        if not self.summary:
            return f"<div>{told}{parameters}</div>"
        found = _summary_table(_summary_text(self.summary), self.summary)
        return f"<div>{told}{parameters}<div style='opacity:{0.4 if self.is_stale else 1}'>{found}</div></div>"


def _follow(reader: "_fettle._NewsReader", view: _View, show: Callable[[str], object]) -> None:
    """Shows what becomes known, until the session ends."""
    while (news := reader.next(None)) is not None:
        while news is not None:
            view.hear(news)
            news = reader.next(0)
        show(view.html())
        time.sleep(REFRESH_SECONDS)
    view.state = "closed"
    show(view.html())


def _end(inner: "_fettle._Session", threads: List[threading.Thread]) -> None:
    inner.close()
    for thread in threads:
        if thread is not threading.current_thread():
            thread.join(END_SECONDS)


def _in_time(found: Optional[T], what: str, timeout: Optional[float]) -> T:
    if found is None:
        raise TimeoutError(f"{what} within {timeout} s")
    return found


def _kernel_display() -> Optional[Callable[..., Any]]:
    """IPython's, where a notebook is behind it; None elsewhere."""
    ipython = sys.modules.get("IPython")
    if ipython is None or getattr(ipython.get_ipython(), "kernel", None) is None:
        return None
    display: Callable[..., Any] = importlib.import_module("IPython.display").display
    return display


_opened = in_plain_words(_fettle._open_session)


class Session:
    """What `open` gives. Its calls may come from any thread. `timeout`: in seconds; None: as long as it takes."""

    def __init__(
        self,
        path: PathLike,
        *,
        mesh_dirs: Sequence[PathLike] = (),
        allow_programs: bool = False,
        unit: str = "auto",
        split: bool = False,
        watch: bool = True,
    ):
        self._inner = _opened(path, mesh_dirs, allow_programs, unit, split, watch)
        self._threads: List[threading.Thread] = []  # of notebooks
        self._end = weakref.finalize(self, _end, self._inner, self._threads)  # at the end of the program too

    def close(self) -> None:
        """Ends what is computed. Nothing can be asked any more."""
        self._end()

    def __enter__(self) -> "Session":
        return self

    def __exit__(self, *raised: object) -> None:
        self.close()

    @property
    def is_closed(self) -> bool:
        return self._inner.is_closed

    @property
    def path(self) -> str:
        return self._inner.path

    @property
    def is_scene(self) -> bool:
        """Was a scene opened, or meshes? What can be changed are its variables then, and nothing is required."""
        return self._inner.is_scene

    @property
    def warnings(self) -> List[str]:
        """Of the files, the meshes and the start."""
        return self._inner.warnings

    @property
    def parameters(self) -> List[Parameter]:
        """With their values as the file has them."""
        return self._inner.parameters

    @property
    def parameter_names(self) -> List[str]:
        return [parameter.name for parameter in self.parameters]

    @property
    def values(self) -> Values:
        """As they were set last, by parameter, SI."""
        return self._inner.values

    @property
    def can_undo(self) -> bool:
        return self._inner.place()[0]

    @property
    def can_redo(self) -> bool:
        return self._inner.place()[1]

    @property
    def is_as_in_file(self) -> bool:
        """Are the values those of the file?"""
        return self._inner.place()[2]

    @property
    def is_tuning(self) -> bool:
        return self._inner.is_tuning

    def set(self, values: Union[Mapping[str, Given], Sequence[Given], ArrayLike, None] = None, /, **named: Given) -> int:
        """Values by name, the others stay: set(gap="0.3mm"), set({"pin radius": 4e-3}); or one for each parameter. The revision. Raises Error
        where there is no such parameter, a value is outside its bounds, or a search runs; then nothing is changed."""
        if values is None:
            return self._inner.set(named)
        if isinstance(values, Mapping):
            return self._inner.set({**values, **named})
        if named:
            raise TypeError("set() takes values of all parameters, or some by name, not both")
        return self._inner.set(values)

    def undo(self) -> int:
        """The values before the last change. The revision. Raises Error where there are none."""
        return self._inner.undo()

    def redo(self) -> int:
        """What was undone last. The revision."""
        return self._inner.redo()

    def reset(self) -> int:
        """The values of the file. The revision."""
        return self._inner.reset()

    def result(self, timeout: Optional[float] = None) -> SessionResult:
        """Waits until all is known of what was set last. Raises EvaluationError, with the reason, where there is no design at these values,
        and TimeoutError."""
        return _in_time(self._inner.result(timeout), "the result was not there", timeout)

    def pull(self, name: str, value: Given, timeout: Optional[float] = None) -> Pulled:
        """Sets the values nearest to the present ones that bring a requirement, or "objective", to `value` to first order. Waits for the
        derivatives at the present ones. Raises as `result` does, and Error where they are not known."""
        return _in_time(self._inner.pull(name, value, timeout), "the derivatives were not there", timeout)

    def tune(self, max_evaluations: Optional[int] = None) -> None:
        """Begins a search from the present values, as `optimise` does; the best is set at the end. Until then nothing else can be set."""
        self._inner.tune(max_evaluations)

    def stop(self) -> None:
        """Ends a search with what it has."""
        self._inner.stop()

    def wait_for_tuning(self, timeout: Optional[float] = None) -> Tuning:
        """Waits for the end of the search; what it has come to. Raises TimeoutError."""
        return _in_time(self._inner.search(timeout), "the search did not end", timeout)

    def news(self, timeout: Optional[float] = None) -> Iterator[News]:
        """The newest of each kind that still holds, then what becomes known from now on; until nothing comes for that time, or the session is
        closed. What is overtaken before it is taken is left out."""
        return self._told(self._inner.news(), timeout)

    def _told(self, reader: "_fettle._NewsReader", timeout: Optional[float]) -> Iterator[News]:
        while (news := reader.next(timeout)) is not None:
            yield news

    def save(self, path: Optional[PathLike] = None, *, replace: bool = False) -> str:
        """Writes the design with the present values, into its own file or another; numbers alone change. Of meshes the scene that they make.
        replace: another file that is there already is written over. The path. Raises Error where a scene was opened."""
        return os.fspath(self._inner.save(path, replace))

    def __repr__(self) -> str:
        try:
            names = self.parameter_names
        except Error:
            return few_lines(f"Session({self.path!r}, closed)")
        return few_lines(f"Session({self.path!r}, {counted(len(names), 'parameter')}{': ' if names else ''}{names_of(names)})")

    def _view(self) -> Tuple[_View, "_fettle._NewsReader"]:
        """With what is known now, and what will be."""
        view, reader = _View(self.path), self._inner.news()
        while (news := reader.next(0)) is not None:
            view.hear(news)
        if self.is_closed:
            view.state = "closed"
        return view, reader

    def _repr_html_(self) -> str:
        """As it is now."""
        return self._view()[0].html()

    def _ipython_display_(self) -> None:
        display = _kernel_display()
        if display is None:
            print(repr(self))
            return
        text = repr(self)
        view, reader = self._view()
        handle = display({"text/html": view.html(), "text/plain": text}, raw=True, display_id=True)

        def show(page: str) -> None:
            handle.update({"text/html": page, "text/plain": text}, raw=True)

        thread = threading.Thread(target=_follow, args=(reader, view, show), name="fettle session view", daemon=True)
        self._threads.append(thread)
        thread.start()


def open(  # pylint: disable=redefined-builtin
    path: PathLike,
    *,
    mesh_dirs: Sequence[PathLike] = (),
    allow_programs: bool = False,
    unit: str = "auto",
    split: bool = False,
    watch: bool = True,
) -> Session:
    """Opens a design; or a scene, whose variables are what can be changed; or a mesh, a folder of them, a 3MF or a STEP file, as the scene that
    `fettle import --joints` makes of it. mesh_dirs: also looked in for meshes. allow_programs: the programs that the file names may be run to
    make its parts. unit, split: of meshes, as `fettle import` has them. watch: the files are read again when they are edited."""
    return Session(path, mesh_dirs=mesh_dirs, allow_programs=allow_programs, unit=unit, split=split, watch=watch)
