# SPDX-License-Identifier: MIT
"""Exploring a design space: sweeps, samples and many starts, in parallel processes of this machine or on a Dask cluster.

    found = fettle.explore("hinge.design.json", "hinge.jsonl", samples=200, workers=4)
    found = fettle.explore(design, "starts.jsonl", starts=20, dask="tcp://10.0.0.5:8786")
    for result in found.best(3):
        print(result["objective"], result["parameters"])

Results land as they come, one JSON object per line, flushed to the disk; the first line says of which design. An exploration that was stopped
goes on where it ended: what the file has is not computed again. A lost worker costs the work on its current design only, which is
given to another one; a design that is lost twice is written down as lost.
"""
import collections
import contextlib
import dataclasses
import fcntl
import hashlib
import itertools
import json
import math
import multiprocessing
import multiprocessing.connection
import multiprocessing.resource_tracker
import os
import pickle
import signal
import threading
import time
from typing import Any, Callable, Deque, Dict, Iterable, Iterator, List, Mapping, Optional, Sequence, TextIO, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from . import _fettle
from ._record import columns, did_you_mean, in_si, units
from .design import Design
from .errors import Error, Fault
from .scene import PathLike

VERSION = 1
FIRST_KEY = '{"fettle_explore"'
DEEPEST = 100  # lists and objects in one another, as everywhere (core/files/json_text.hpp)
MOST_DESIGNS = 1_000_000  # of one exploration
DASK_SECONDS = 10  # for a scheduler to answer
Result = Dict[str, Any]
Progress = Callable[[int, int, Result], object]


@dataclasses.dataclass(frozen=True)
class Job:
    """One design to evaluate (`point`, SI), one run of the optimiser (`seed`), or one sample of tolerances (its number as `seed`) to make."""

    kind: str  # "evaluate", "optimise" or "sample"
    point: Tuple[float, ...] = ()
    seed: int = 0

    @property
    def key(self) -> str:
        """The same for the same job, by the bits of its numbers."""
        text = f"{self.kind} {self.seed} " + " ".join(float(x).hex() for x in self.point)
        return hashlib.sha256(text.encode()).hexdigest()[:16]


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


def _design_name(design: Design, files: str) -> str:
    """files: the hash of those that it was read from."""
    return hashlib.sha256((_canonical(design) + _fettle.__version__ + files).encode()).hexdigest()[:16]


def _number(value: float) -> Optional[float]:
    return float(value) if math.isfinite(value) else None


_ONE_OPTIMISER = threading.Lock()  # Ipopt is not for several threads of one process, which a Dask worker can have


class _Worker:
    """What a process keeps between jobs: the problem."""

    problems: Dict[str, _fettle.DesignProblem] = {}
    samples: Dict[str, _fettle.SharedSamples] = {}

    @classmethod
    def problem(cls, name: str, design: bytes) -> _fettle.DesignProblem:
        if name not in cls.problems:
            cls.problems.clear()
            cls.problems[name] = _fettle.DesignProblem(pickle.loads(design))
        return cls.problems[name]


    @classmethod
    def sample(cls, name: str, arguments: bytes, number: int) -> Result:
        """Of fettle.tolerance (tolerances.py)."""
        if name not in cls.samples:
            cls.samples.clear()
            shared = _fettle.SharedSamples(*pickle.loads(arguments))
            if shared.name != name:
                raise ValueError("the files of the design that this worker finds are others, or its fettle is")
            cls.samples[name] = shared
        return {"status": "made", "line": cls.samples[name].line_of(number)}


def _evaluated(problem: _fettle.DesignProblem, job: Job) -> Result:
    at = problem.evaluate(np.array(job.point), gradients=False)
    if not at.usable:
        return {"status": "unusable", "reason": at.reason}
    return {"status": "feasible" if at.violation <= 0 else "infeasible", **_measured(problem, at)}


def _measured(problem: _fettle.DesignProblem, at: Any) -> Result:
    design = problem.design
    return {
        "objective": _number(at.objective),
        "violation": _number(at.violation),
        "terms": {term.name: _number(m.value) for term, m in zip(design.objective, at.terms)},
        "constraints": {c.name: _number(m.value) for c, m in zip(design.constraints, at.constraints)},
        "certified": {c.name: _number(m.lower) for c, m in zip(design.constraints, at.constraints) if m.is_proven},
    }


def _optimised(problem: _fettle.DesignProblem, job: Job) -> Result:
    with _ONE_OPTIMISER:
        outcome = _fettle.optimise(problem, seed=job.seed)
    result = {"status": outcome.report.status, "reason": outcome.report.message, "evaluations": outcome.report.evaluations}
    result["parameters"] = dict(zip(problem.parameter_names, map(float, outcome.report.point)))
    if outcome.sides:
        result["sides"] = {side.joint: side.assemble.side for side in outcome.sides}
    if outcome.final.usable:
        result.update(_measured(problem, outcome.final))
    return result


def run_job(name: str, design: bytes, job: Job) -> Result:
    """One job, on one thread; what it raises becomes a result with status "failed"."""
    begin = time.perf_counter()
    limit = _fettle.ThreadLimit(1)
    try:
        if job.kind == "sample":
            return {"key": job.key, "kind": job.kind, "seed": job.seed, **_Worker.sample(name, design, job.seed)}
        problem = _Worker.problem(name, design)
        start = job.point if job.kind == "evaluate" else tuple(_fettle.start_of_seed(problem, job.seed))
        result: Result = {"parameters": dict(zip(problem.parameter_names, map(float, start)))}
        result.update(_evaluated(problem, job) if job.kind == "evaluate" else _optimised(problem, job))
    except Exception as raised:  # of the design's own shapes and quantities: any
        result = {"status": "failed", "reason": f"{type(raised).__name__}: {raised}"}
    del limit
    return {"key": job.key, "kind": job.kind, "seed": job.seed, **result, "seconds": time.perf_counter() - begin}


SAFE_PATH = "PYTHONSAFEPATH"


@contextlib.contextmanager
def _starting_processes() -> Iterator[None]:
    """Processes that are started meanwhile do not look for modules in the folder that they run in, which may be anyone's; and Ctrl-C, which
    reaches them too, waits until they know what to do with it."""
    given = os.environ.get(SAFE_PATH)
    held = signal.pthread_sigmask(signal.SIG_BLOCK, ())
    os.environ[SAFE_PATH] = "1"
    try:
        multiprocessing.resource_tracker.ensure_running()  # it would take Ctrl-C's block away where the first process is started
        signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT,))
        yield
    finally:
        if given is None:
            del os.environ[SAFE_PATH]
        else:
            os.environ[SAFE_PATH] = given
        signal.pthread_sigmask(signal.SIG_SETMASK, held)


def _serve(pipe: Any, name: str, design: bytes, safe_path: Optional[str]) -> None:
    """A worker process: jobs in, results out, until the pipe closes. Whoever got Ctrl-C ends it. safe_path: of the environment of programs
    that it runs."""
    os.environ.pop(SAFE_PATH, None)
    if safe_path is not None:
        os.environ[SAFE_PATH] = safe_path
    signal.signal(signal.SIGINT, lambda *_: None)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, (signal.SIGINT,))
    with contextlib.suppress(EOFError, ConnectionError):  # reset, where what was sent has not been read
        while True:
            pipe.send(run_job(name, design, pipe.recv()))


def _lost(job: Job) -> Result:
    return {"key": job.key, "kind": job.kind, "seed": job.seed, "status": "lost", "reason": "two workers were lost on this design"}


@dataclasses.dataclass
class _Local:
    """One worker process, and what it works on."""

    process: Any
    pipe: Any
    job: Optional[Job] = None

    def close(self) -> None:
        self.pipe.close()
        self.process.terminate()
        self.process.join()


class _LocalPool:
    """Workers beside this process. One that ends, however it ends, is replaced."""

    def __init__(self, workers: int, name: str, design: bytes):
        self.arguments = (name, design, os.environ.get(SAFE_PATH))
        self.context = multiprocessing.get_context("spawn")
        self.workers = [self._start() for _ in range(workers)]

    def _start(self) -> _Local:
        here, there = self.context.Pipe()
        process = self.context.Process(target=_serve, args=(there, *self.arguments), daemon=True)
        with _starting_processes():
            process.start()
        there.close()
        return _Local(process, here)

    def run(self, jobs: Iterable[Job]) -> Iterator[Result]:
        """Results as they come."""
        waiting: Deque[Job] = collections.deque(jobs)
        lost_once = set()
        while waiting or any(worker.job for worker in self.workers):
            for i, worker in enumerate(self.workers):
                if worker.job is None and waiting:
                    worker.job = waiting.popleft()
                    try:
                        worker.pipe.send(worker.job)
                    except OSError:
                        pass  # its end is seen below
            busy = {worker.pipe: i for i, worker in enumerate(self.workers) if worker.job}
            for ready in multiprocessing.connection.wait(list(busy)):
                i = busy[ready]
                job = self.workers[i].job
                assert job is not None
                try:
                    result = self.workers[i].pipe.recv()
                    self.workers[i].job = None
                    yield result
                except (EOFError, OSError):
                    self.workers[i].close()
                    self.workers[i] = self._start()
                    if job.key in lost_once:
                        yield _lost(job)
                    else:
                        lost_once.add(job.key)
                        waiting.appendleft(job)

    def close(self) -> None:
        for worker in self.workers:
            worker.close()


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


def _run_on_dask(client: Any, name: str, design: bytes, jobs: Sequence[Job]) -> Iterator[Result]:
    """On the scheduler's workers, which have this package. Designs of a lost worker are given to others by the scheduler."""
    from distributed import KilledWorker, as_completed

    # The design goes with each job: what is scattered is lost with the workers that have it.
    futures = {client.submit(run_job, name, design, job, pure=False): job for job in jobs}
    for future in as_completed(futures, loop=client.loop):  # type: ignore[no-untyped-call]
        try:
            yield future.result()
        except KilledWorker:
            yield _lost(futures[future])


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


def _refused(name: str) -> float:
    raise ValueError(f"{name} is no number of JSON")


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"{text[:40]} is too large a number")
    return value


def _whole(text: str) -> int:
    _finite(text)
    return int(text)


def _is_shallow(value: Any, levels: int = DEEPEST) -> bool:
    """Are no more than so many lists and objects in one another?"""
    if not isinstance(value, (dict, list)):
        return True
    return levels > 0 and all(_is_shallow(each, levels - 1) for each in (value.values() if isinstance(value, dict) else value))


def _is_result(record: Any) -> bool:
    """Does a line have the members of a result, each of its type?"""

    def numbers(value: Any) -> bool:
        return isinstance(value, dict) and all(x is None or isinstance(x, (int, float)) for x in value.values())

    if not isinstance(record, dict) or not all(isinstance(record.get(key), str) for key in ("key", "status")):
        return False
    groups = [record[key] for key in ("parameters", "terms", "constraints", "certified") if key in record]
    single = {key: record.get(key) for key in ("objective", "violation")}
    return numbers(single) and all(map(numbers, groups))


def _record(where: str, line: str, is_header: bool) -> Result:
    """A line of the file, checked."""
    try:
        record: Result = json.loads(line, parse_constant=_refused, parse_float=_finite, parse_int=_whole)
        if not _is_shallow(record):
            raise ValueError(f"more than {DEEPEST} lists and objects in one another are refused")
    except (ValueError, RecursionError) as fault:
        raise _fail("parse", where, f"the line is damaged: {fault}; take it out, or name another file") from fault
    if not is_header and not _is_result(record):
        message = "the line is damaged: it is no result of an exploration; take it out, or name another file"
        raise _fail("wrong_type", where, message)
    return record


def read_exploration(path: PathLike) -> Exploration:
    """Reads a file of explore(). A last line that was cut off is left out."""
    path = os.fspath(path)
    try:
        with open(path, encoding="utf-8") as file:
            lines = file.read().split("\n")
    except UnicodeDecodeError as fault:
        raise _fail("parse", str(path), f"it is no text: {fault}") from fault
    whole = [(number, line) for number, line in enumerate(lines[:-1], 1) if line]  # what follows the last line feed was cut off
    records = [_record(f"{path}:{number}", line, is_header=k == 0) for k, (number, line) in enumerate(whole)]
    if not records or not isinstance(records[0], dict) or records[0].get("fettle_explore") != VERSION:
        raise _fail("missing_key", str(path), f"not an exploration: its first line has no `fettle_explore` {VERSION}")
    return Exploration(records[0], records[1:])


def swept_faults(names: Sequence[str], sweep: Mapping[str, Union[int, Sequence[float]]]) -> List[Fault]:
    """What is wrong with a sweep of these parameters."""
    faults, designs = [], 1
    for name, values in sweep.items():
        where = f"sweep/{name}"
        count = values if isinstance(values, int) else len(values)
        designs *= count
        if name not in names:
            faults.append(Fault("unknown_key", where, f"there is no parameter {name!r}; {did_you_mean(name, names)}"))
        elif count < 1:
            faults.append(Fault("out_of_range", where, f"{count} values are not allowed: 1 or more are"))
        elif not isinstance(values, int) and not all(math.isfinite(x) for x in values):
            faults.append(Fault("not_finite", where, "the values are finite numbers"))
    return faults + too_many("sweep", designs)


def too_many(where: str, designs: int) -> List[Fault]:
    """Each is planned before the first is made, so there is an end to what memory holds."""
    if designs <= MOST_DESIGNS:
        return []
    return [Fault("out_of_range", where, f"{designs} designs are not allowed: up to {MOST_DESIGNS} are")]


def _swept_in_si(design: Design, sweep: Mapping[str, Union[int, Sequence[Any]]]) -> Dict[str, Union[int, Sequence[float]]]:
    """A sweep whose values may have units."""
    dimensions = {p.name: units().get(p.unit, "number") for p in design.parameters}
    return {
        name: values if isinstance(values, int) else in_si(list(values), dimensions.get(name, "number"), f"sweep/{name}")
        for name, values in sweep.items()
    }


def grid(problem: _fettle.DesignProblem, sweep: Mapping[str, Union[int, Sequence[float]]]) -> List[Job]:
    """Every combination of the swept parameters (SI values, or how many between the bounds), the others as the design has them."""
    names = problem.parameter_names
    swept = {}
    for name, values in sweep.items():
        k = names.index(name)
        swept[k] = np.linspace(problem.lower[k], problem.upper[k], values) if isinstance(values, int) else np.asarray(values, float)
    jobs = []
    for combination in itertools.product(*swept.values()):
        point = problem.values
        point[list(swept)] = combination
        problem.check(point)
        jobs.append(Job("evaluate", tuple(point)))
    return jobs


def _jobs(
    problem: _fettle.DesignProblem, sweep: Mapping[str, Union[int, Sequence[float]]], samples: int, starts: int, seed: int
) -> List[Job]:
    jobs = grid(problem, sweep) if sweep else []
    seeds = _fettle.seeds_of_list(seed, 1 + max(samples, starts))  # as `fettle optimise --starts` has them
    jobs += [Job("evaluate", tuple(_fettle.sample_of_seed(problem, drawn))) for drawn in seeds[1 : samples + 1]]
    jobs += [Job("optimise", seed=start) for start in seeds[:starts]]
    return list({job.key: job for job in jobs}.values())


def _make_folder_of(path: str) -> None:
    folder = os.path.dirname(path) or "."
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as fault:
        raise _fail("file_unwritable", folder, f"the folder cannot be made: {fault.strerror}") from fault


@contextlib.contextmanager
def _results_file(path: str, header: Result) -> Iterator[Tuple[TextIO, List[Result]]]:
    """The file, locked, at its end; and what it has already. A new file goes again where it gets no result, for something was raised."""
    if os.path.exists(path) and not os.path.isfile(path):
        raise _fail("file_unwritable", path, "results are added to it and read again: it has to be a regular file")
    try:
        file = open(path, "a+", encoding="utf-8")
    except OSError as fault:
        raise _fail("file_unwritable", path, f"the file cannot be opened for writing: {fault.strerror}") from fault
    with file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as fault:
            raise _fail("file_unreadable", path, "another exploration is writing this file") from fault
        file.seek(0)
        try:
            text = file.read()
        except UnicodeDecodeError as fault:
            raise _fail("parse", path, "this file is no exploration; name another one") from fault
        if not text.startswith(FIRST_KEY[: len(text)]):
            raise _fail("parse", path, "this file is no exploration; name another one")
        whole = text[: text.rfind("\n") + 1]
        if len(whole) < len(text):
            file.truncate(len(whole.encode()))
        results: List[Result] = []
        if whole:
            known = read_exploration(path)
            if any(known.header.get(key) != header[key] for key in header if key != "file"):
                raise _fail("inconsistent", path, "this file is the exploration of another design; name another file")
            results = known.results
        else:
            try:
                _write(file, header)
            except Error:
                os.unlink(path)
                raise
        begin = _size(file)
        try:
            yield file, results
        except BaseException:
            if not whole and _size(file) == begin:
                os.unlink(path)
            raise


def _size(file: TextIO) -> int:
    return os.fstat(file.fileno()).st_size


def _write(file: TextIO, record: Result) -> None:
    """A whole line at the end, on the disk; none, and an Error, where it cannot be written."""
    line = (json.dumps(record, allow_nan=False) + "\n").encode()
    begin = _size(file)
    try:
        while line:
            line = line[os.write(file.fileno(), line) :]
        os.fsync(file.fileno())
    except OSError as fault:
        with contextlib.suppress(OSError):
            os.ftruncate(file.fileno(), begin)
        raise _fail("file_unwritable", file.name, f"the file cannot be written: {fault.strerror}") from fault


class Unwritten(Error):
    """The file cannot take what was found: `found` has all of it."""

    def __init__(self, fault: Error, found: Exploration):
        super().__init__(fault.errors)
        self.found = found


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
    """Evaluates designs, or optimises from starts, in parallel, and writes each result to `out` as it comes.

    design: a Design that can be pickled, or the path of a *.design.json. sweep: {parameter: values (SI, or with units, "9mm"), or how many
    between its bounds}, all combinations. samples: so many designs drawn from the bounds. starts: so many runs of the optimiser, the first
    from the design's own values. seed: of samples and starts; the same seed gives the same ones on any machine. workers: processes
    (default: the processors).
    dask: address of a scheduler, whose workers are used instead; one that does not answer within 10 s is an error. It gets the design as a
    pickle and answers with pickles: whoever reaches it can run code on its workers, and here. progress(done, of, result).
    Raises Unwritten, which has all that was found, where the file cannot take it (a full disk)."""
    faults = [
        Fault("out_of_range", name, f"{value} is not allowed: {least} or more is")
        for name, value, least in (("samples", samples, 0), ("starts", starts, 0), ("seed", seed, 0), ("workers", workers, 1))
        if value is not None and value < least
    ]
    out = os.fspath(out)
    path = os.fspath(design) if isinstance(design, (str, os.PathLike)) else None
    files = ""
    if isinstance(design, (str, os.PathLike)):
        file_of_design, files = _fettle.read_design_and_hash(design, allow_programs=allow_programs)
        design = file_of_design.design
    problem = _fettle.DesignProblem(design)
    faults += too_many("samples", samples) + too_many("starts", starts)
    in_numbers = _swept_in_si(design, sweep or {})
    faults += swept_faults(problem.parameter_names, in_numbers)
    if faults:
        raise Error(faults)
    packed = pickle.dumps(design)
    name = _design_name(design, files)
    header: Result = {"fettle_explore": VERSION, "program": _fettle.__version__, "design": name, "parameters": problem.parameter_names}
    if path is not None:  # from the file of results, so that both can be moved together
        beside = os.path.relpath(path, os.path.dirname(out) or ".")
        if beside.isprintable():  # JSON has no others
            header["file"] = beside
    jobs = _jobs(problem, in_numbers, samples, starts, seed)
    del problem
    with contextlib.ExitStack() as stack:
        client = stack.enter_context(_dask_client(dask)) if dask is not None else None
        _make_folder_of(out)
        file, known = stack.enter_context(_results_file(out, header))
        done = {result["key"] for result in known if result["status"] != "lost"}
        wanted = [job for job in jobs if job.key not in done]
        count = len(jobs) - len(wanted)
        results: Iterator[Result] = iter(())
        if client and wanted:
            results = _run_on_dask(client, name, packed, wanted)
        elif wanted:
            pool = _LocalPool(min(workers or os.cpu_count() or 1, len(wanted)), name, packed)
            stack.callback(pool.close)
            results = pool.run(wanted)
        found = list(known)
        for result in results:
            found.append(result)
            try:
                _write(file, result)
            except Error as fault:
                raise Unwritten(fault, Exploration(header, found)) from fault
            count += 1
            if progress:
                progress(count, len(jobs), result)
    return read_exploration(out)
