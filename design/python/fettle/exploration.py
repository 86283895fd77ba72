# SPDX-License-Identifier: MIT
"""Exploring a design space: sweeps, samples and many starts, several at once on this machine or on a Dask cluster.

    found = fettle.explore("hinge.design.json", "hinge.jsonl", samples=200)
    found = fettle.explore(design, "starts.jsonl", starts=20, dask="tcp://10.0.0.5:8786")
    for result in found.best(3):
        print(result["objective"], result["parameters"])

Results land as they come, one JSON object per line, flushed to the disk; the first line says of which design. An exploration that was stopped
goes on where it ended: what the file has is not computed again. What is explored and how each result comes about is the library's
(design/studies/exploration.hpp); here is what reaches a cluster, on which a lost worker costs the work on its current design only.
"""
import collections
import contextlib
import dataclasses
import hashlib
import json
import math
import os
import pickle
from typing import Any, Callable, Dict, Iterable, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from . import _fettle
from ._record import columns, in_si, units
from .design import Design
from .errors import Error, Fault
from .scene import PathLike

DASK_SECONDS = 10  # for a scheduler to answer
Result = Dict[str, Any]
Progress = Callable[[int, int, Result], object]


def _canonical(value: Any) -> str:
    """The same text for the same plain data, whoever made it."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        members = {field.name: getattr(value, field.name) for field in dataclasses.fields(value)}
        return type(value).__qualname__ + _canonical(members)
    if isinstance(value, dict):
        return "{" + ",".join(f"{_canonical(k)}:{_canonical(v)}" for k, v in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ",".join(map(_canonical, value)) + "]"
    if isinstance(value, np.ndarray):
        return _canonical(value.tolist())
    if isinstance(value, (bool, int, str, type(None))):
        return repr(value)
    if isinstance(value, float):
        return float(value).hex()
    return hashlib.sha256(pickle.dumps(value)).hexdigest()


def _design_name(design: Design) -> str:
    return hashlib.sha256((_canonical(design) + _fettle.__version__).encode()).hexdigest()[:16]


class _Worker:
    """What a process of a cluster keeps between jobs: the problem, or what makes the samples."""

    made: Dict[str, Any] = {}

    @classmethod
    def keep(cls, name: str, make: Callable[[], Any]) -> Any:
        if name not in cls.made:
            cls.made.clear()
            cls.made[name] = make()
        return cls.made[name]


def run_job(name: str, design: bytes, job: "_fettle._ExplorationJob") -> str:
    """One job on one thread of a cluster: its result as a line."""
    limit = _fettle.ThreadLimit(1)
    problem = _Worker.keep(name, lambda: _fettle.DesignProblem(pickle.loads(design)))
    line = str(_fettle._result_of(problem, job))
    del limit
    return line


def make_sample(name: str, arguments: bytes, number: int) -> str:
    """One sample of fettle.tolerance (tolerances.py), as a line."""

    def make() -> _fettle.SharedSamples:
        shared = _fettle.SharedSamples(*pickle.loads(arguments))
        if shared.name != name:
            raise ValueError("the files of the design that this worker finds are others, or its fettle is")
        return shared

    limit = _fettle.ThreadLimit(1)
    line = str(_Worker.keep(name, make).line_of(number))
    del limit
    return line


def _dask_client(address: str) -> Any:
    """A client of a running scheduler. A wrong address, or one where nobody answers, is an error within DASK_SECONDS."""
    try:
        from distributed import Client
        from distributed.comm.addressing import get_address_host_port
    except ImportError as fault:
        raise _fail("file_not_found", "dask", "there is no Dask: install Debian's python3-distributed, or leave this out") from fault
    try:
        get_address_host_port(address)  # Client would wait for what can never be
    except (ValueError, NotImplementedError) as fault:
        raise _fail("parse", "dask", f"{address!r} is no address of a scheduler, as tcp://10.0.0.5:8786 is: {fault}") from fault
    try:
        return Client(address, timeout=DASK_SECONDS, set_as_default=False)  # type: ignore[no-untyped-call]
    except (OSError, TimeoutError) as fault:
        message = f"no Dask scheduler answered at {address} within {DASK_SECONDS} s; is one running there?"
        raise _fail("file_not_found", "dask", message) from fault


def run_on_dask(client: Any, work: Callable[..., str], arguments: Tuple[Any, ...], jobs: Iterable[Any]) -> Iterator[Tuple[Any, Optional[str]]]:
    """(job, its line) as they come, from the scheduler's workers, which have this package; None for a line: two workers were lost on the
    job. What a lost worker had to do is given to others by the scheduler."""
    from distributed import KilledWorker, as_completed

    # What is worked on goes with each job: what is scattered is lost with the workers that have it.
    futures = {client.submit(work, *arguments, job, pure=False): job for job in jobs}
    for future in as_completed(futures, loop=client.loop):  # type: ignore[no-untyped-call]
        try:
            yield futures[future], future.result()
        except KilledWorker:
            yield futures[future], None


class Exploration:
    """What an exploration's file holds."""

    def __init__(self, header: Result, results: List[Result]):
        self.header = header
        self.results = results

    def __len__(self) -> int:
        return len(self.results)

    def where(self, wanted: Callable[[Result], bool]) -> List[Result]:
        """The results that `wanted` is true of."""
        return [result for result in self.results if wanted(result)]

    def best(self, count: int = 1) -> List[Result]:
        """Those with the least objective among the designs that meet every requirement."""
        met = self.where(lambda r: r.get("violation") is not None and r["violation"] <= 0 and r.get("objective") is not None)
        return sorted(met, key=lambda r: float(r["objective"]))[:count]

    def column(self, name: str) -> NDArray[np.float64]:
        """One value of every result: "objective", "violation", or a parameter's, term's or constraint's value; NaN where there is none."""

        def value(result: Result) -> float:
            for group in (result, result.get("parameters", {}), result.get("terms", {}), result.get("constraints", {})):
                if isinstance(group.get(name), (int, float)):
                    return float(group[name])
            return math.nan

        return np.array([value(result) for result in self.results])

    def __repr__(self) -> str:
        counts = collections.Counter(str(result["status"]) for result in self.results)
        told = ", ".join(f"{count} {status}" for status, count in counts.most_common())
        return f"Exploration({len(self)} designs{': ' if told else ''}{told})"

    def _repr_html_(self) -> str:
        names: List[str] = list(self.header.get("parameters", []))
        rows = [[r["status"], r.get("objective"), *(r.get("parameters", {}).get(name) for name in names)] for r in self.best(10)]
        return columns(f"{len(self)} designs; the best, SI", ["status", "objective", *names], rows)


def _fail(code: str, where: str, message: str) -> Error:
    return Error([Fault(code, where, message)])


def read_exploration(path: PathLike) -> Exploration:
    """Reads a file of explore(). A last line that was cut off is left out; another that is damaged is an error."""
    return _found(json.loads(_fettle._read_exploration(path)))


def _found(told: Result) -> Exploration:
    return Exploration(told["header"], told["results"])


class Unwritten(Error):
    """The file cannot take what was found: `found` has all of it."""

    def __init__(self, faults: Sequence[Fault], found: Exploration):
        super().__init__(list(faults))
        self.found = found


def _swept_in_si(design: Design, sweep: Mapping[str, Union[int, Sequence[Any]]]) -> Dict[str, Union[int, List[float]]]:
    """A sweep whose values may have units."""
    dimensions = {p.name: units().get(p.unit, "number") for p in design.parameters}
    return {
        name: values if isinstance(values, int) else list(in_si(list(values), dimensions.get(name, "number"), f"sweep/{name}"))
        for name, values in sweep.items()
    }


def explore(
    design: Union[Design, PathLike],
    out: PathLike,
    *,
    sweep: Optional[Mapping[str, Union[int, Sequence[Union[float, str]]]]] = None,
    samples: int = 0,
    starts: int = 0,
    seed: int = 1,
    workers: Optional[int] = None,
    dask: Optional[str] = None,
    allow_programs: bool = False,
    progress: Optional[Progress] = None,
) -> Exploration:
    """Evaluates designs, or optimises from starts, several at once, and writes each result to `out` as it comes.

    design: a Design, or the path of a *.design.json. sweep: {parameter: values (SI, or with units, "9mm"), or how many between its bounds},
    all combinations. samples: so many designs drawn from the bounds. starts: so many runs of the optimiser, the first from the design's own
    values. seed: of samples and starts; the same seed gives the same ones on any machine. workers: how many designs at once (default: one
    for each processor); those of a design whose own shapes or quantities are Python's take turns in these.
    dask: address of a scheduler, whose workers are used instead; one that does not answer within 10 s is an error. It gets the design as a
    pickle and answers with pickles: whoever reaches it can run code on its workers, and here. progress(done, of, result).
    Raises Unwritten, which has all that was found, where the file cannot take it (a full disk)."""
    if workers is not None and workers < 1:
        raise _fail("out_of_range", "workers", f"{workers} is not allowed: 1 or more is")
    out = os.fspath(out)
    name, file = "", ""
    if isinstance(design, (str, os.PathLike)):
        file = os.path.relpath(design, os.path.dirname(out) or ".")  # from the file of results, so that both can be moved together
        read, name = _fettle._read_design_and_hash(design, allow_programs=allow_programs)
        design = read.design
    problem = _fettle.DesignProblem(design)
    jobs = _fettle._exploration_jobs(problem, _swept_in_si(design, sweep or {}), samples, starts, seed)
    with contextlib.ExitStack() as stack:
        client = stack.enter_context(_dask_client(dask)) if dask is not None else None
        packed = pickle.dumps(design) if client else b""
        name = name or _design_name(design)
        results = stack.enter_context(_fettle._ExplorationFile(out, problem, name, file))
        if client is None:
            limit = None if workers is None else _fettle.ThreadLimit(workers)
            unwritten = results.explore(problem, jobs, None if progress is None else _told(progress))
            del limit
        else:
            unwritten = _explore_on_dask(client, (name, packed), jobs, results, progress)
        found = _found(json.loads(results.found()))
    if unwritten:
        raise Unwritten(unwritten, found)
    return found


def _told(progress: Progress) -> Callable[[int, int, str], object]:
    return lambda done, of, line: progress(done, of, json.loads(line))


def _explore_on_dask(client: Any, arguments: Tuple[str, bytes], jobs: Sequence[Any], results: Any, progress: Optional[Progress]) -> List[Fault]:
    """@return why the file could not take a result"""
    wanted = [job for job in jobs if not results.has(job.key)]
    done = len(jobs) - len(wanted)
    for job, line in run_on_dask(client, run_job, arguments, wanted):
        line = line or _fettle._lost_result(job)
        unwritten: List[Fault] = results.append(line)
        if unwritten:
            return unwritten
        done += 1
        if progress:
            progress(done, len(jobs), json.loads(line))
    return []
