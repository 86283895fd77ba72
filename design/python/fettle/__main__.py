# SPDX-License-Identifier: MIT
"""python3 -P -m fettle explore DESIGN --out FILE: explores a design space from the command line. The other commands are the program's.
(-P: without it Python takes modules from the current folder first, whatever lies there.)"""
import argparse
import contextlib
import dataclasses
import errno
import json
import math
import os
import re
import signal
import sys
from typing import Any, Callable, Dict, List, NoReturn, Optional, Sequence, Union

from . import _fettle
from .errors import Error, Fault
from .exploration import Exploration, Unwritten, explore, read_exploration, swept_faults

EXIT_DONE, EXIT_VIOLATED, EXIT_BAD_INPUT, EXIT_INTERNAL = 0, 1, 3, 4
EXIT_SIGNAL = 128  # and the number of the signal that asked for the end
FORMS = "NAME=COUNT or NAME=LOW:HIGH:COUNT is expected"


class Parser(argparse.ArgumentParser):
    """One whose errors are those of the other commands."""

    def error(self, message: str) -> NoReturn:
        raise Error([Fault("unsupported", "command line", f"{message}; see fettle explore --help")])


def number_of(word: str, text: str, kind: Callable[[str], Any], where: str) -> Any:
    """What stands for this word of FORMS."""
    try:
        return kind(text)
    except ValueError:
        wanted = "a whole number" if kind is int else "a number, in the parameter's own unit and without it"
        raise Error([Fault("parse", where, f"{FORMS}; {word} is {wanted}, found {text!r}")]) from None


def check_near_bounds(parameter: Any, values: Sequence[float], where: str) -> None:
    """Checks values as the problem does (description::check_values), but reports them in the parameter's own unit, in which they were given."""
    lower, upper, unit = parameter.lower, parameter.upper, parameter.unit

    def in_unit(value: float) -> str:
        return f"{_fettle.from_si(value, unit):.6g} {unit}" if unit not in ("", "1") else f"{value:.6g}"

    faults = [
        Fault(
            "out_of_range",
            where,
            f"{in_unit(value)} is far outside the bounds, {in_unit(lower)} to {in_unit(upper)}: farther than they are apart. "
            "If it is meant, widen the bounds",
        )
        for value in values
        if value < lower - (upper - lower) or value > upper + (upper - lower)
    ]
    if faults:
        raise Error(faults)


def swept(text: str, design: Any) -> Dict[str, Union[int, List[float]]]:
    """The values of NAME=COUNT, or NAME=LOW:HIGH:COUNT in the parameter's own unit: {name: count, or values in SI}."""
    name, _, values = text.rpartition("=")
    where = f"--sweep {text}"
    parts = values.split(":")
    if not name or len(parts) not in (1, 3):
        raise Error([Fault("parse", where, FORMS)])
    count = number_of("COUNT", parts[-1], int, where)
    ends = [number_of(end, text, float, where) for end, text in zip(("LOW", "HIGH"), parts[:-1])]
    if count < 1:
        raise Error([Fault("out_of_range", where, f"{count} values are not allowed: 1 or more are")])
    if not all(map(math.isfinite, ends)):
        raise Error([Fault("not_finite", where, "both ends are finite numbers")])
    faults = swept_faults([p.name for p in design.parameters], {name: count})
    if faults:
        raise Error([Fault(fault.code, where, fault.message) for fault in faults])
    if not ends:
        return {name: count}
    parameter = next(p for p in design.parameters if p.name == name)
    low, high = (_fettle.to_si(end, parameter.unit) if parameter.unit else end for end in ends)
    check_near_bounds(parameter, (low, high) if count > 1 else (low,), where)
    return {name: [low + (high - low) * k / max(1, count - 1) for k in range(count)]}


def sweep_of(texts: Sequence[str], design: Any) -> Dict[str, Union[int, List[float]]]:
    """The values of all --sweep. Raises Error with every fault that was found."""
    sweep: Dict[str, Union[int, List[float]]] = {}
    faults: List[Fault] = []
    for text in texts:
        try:
            one = swept(text, design)
        except Error as fault:
            faults += fault.errors
            continue
        if one.keys() & sweep.keys():
            faults.append(Fault("inconsistent", f"--sweep {text}", "this parameter is swept twice; give it once"))
        sweep.update(one)
    if faults:
        raise Error(faults)
    return sweep


def arguments() -> argparse.ArgumentParser:
    parser = Parser(prog="fettle", description="fettle: exploring a design space")
    commands = parser.add_subparsers(dest="command", required=True)
    command = commands.add_parser("explore", help="many designs or starts in parallel, results as JSON lines")
    command.add_argument("design", metavar="DESIGN")
    command.add_argument("--out", required=True, help="file of the results; an exploration that is there goes on")
    command.add_argument("--sweep", action="append", default=[], metavar="NAME=COUNT", help="or NAME=LOW:HIGH:COUNT, in its unit")
    command.add_argument("--samples", type=int, default=0, help="so many designs, drawn from the bounds")
    command.add_argument("--starts", type=int, default=0, help="so many runs of the optimiser")
    command.add_argument("--seed", type=int, default=1)
    command.add_argument("--workers", type=int, help="processes (default: the processors)")
    command.add_argument("--dask", metavar="ADDRESS", help="of a running Dask scheduler; an error where it does not answer within 10 s")
    command.add_argument("--allow-programs", action="store_true", help="run the programs that a scene names to make its parts")
    command.add_argument("--json", action="store_true", help="one JSON object on stdout and nothing else there")
    command.add_argument("--quiet", action="store_true")
    return parser


def progress_line(done: int, of: int, result: Dict[str, Any]) -> str:
    objective = result.get("objective")
    reason = result.get("reason", "")
    told = f", objective {objective:.6g}" if objective is not None else f": {reason}" if reason else ""
    return f"design {done} of {of} is {result['status']}{told}"


def run(options: argparse.Namespace) -> int:
    def tell(done: int, of: int, result: Dict[str, Any]) -> None:
        Stopped.check()
        if not options.quiet:
            say(progress_line(done, of, result))

    design = _fettle.read_design(options.design, allow_programs=options.allow_programs).design
    sweep = sweep_of(options.sweep, design)
    if not sweep and options.samples == 0 and options.starts == 0:
        raise Error([Fault("missing_key", "command line", "nothing to explore: give --sweep, --samples or --starts")])
    Stopped.check()
    try:
        found = explore(
            options.design,
            options.out,
            sweep=sweep,
            samples=options.samples,
            starts=options.starts,
            seed=options.seed,
            workers=options.workers,
            dask=options.dask,
            allow_programs=options.allow_programs,
            progress=tell,
        )
    except Unwritten as fault:  # what was found is told all the same
        answer(fault.found, options, fault.errors)
        for each in fault.errors:
            say(error_line(each.where, each))
        return EXIT_BAD_INPUT
    return answer(found, options, [])


def answer(found: Exploration, options: argparse.Namespace, unwritten: Sequence[Fault]) -> int:
    """Tells what was found."""
    best = next(iter(found.best()), None)
    if options.json:
        told: Dict[str, Any] = {"status": "ok" if best else "infeasible", "results": len(found), "best": best, "out": options.out}
        if unwritten:
            told["unwritten"] = [dataclasses.asdict(fault) for fault in unwritten]
        put_json(told)
    else:
        text = "none meets every requirement"
        if best:
            met = len(found.best(len(found)))
            text = f"{met} meet{'s' if met == 1 else ''} every requirement, the best with the objective {best['objective']:.6g}"
        if unwritten and best:
            text += ", at " + ", ".join(f"{name} {value:.9g}" for name, value in best["parameters"].items()) + " (SI)"
        if not unwritten:
            text += f"\nto look at them: fettle report {options.out}"
        put(printed(f"{len(found)} designs{'' if unwritten else ' in ' + options.out}; {text}"))
    return EXIT_DONE if best else EXIT_VIOLATED


def printed(text: str) -> str:
    """As core/base/printed_text.hpp has it: control characters, which paths and names can hold, are shown, and no line is a command to a runner of
    checks."""
    text = "".join(c if c.isprintable() or c == "\n" else ascii(c)[1:-1] for c in text)
    return re.sub(r"^(\s*):(?=:)", r"\1\\x3a", text, flags=re.MULTILINE).replace("##[", r"\x23#[")


def say(text: str) -> None:
    """The one way to standard error."""
    print(printed(text), file=sys.stderr)


def error_line(where: str, fault: Fault) -> str:
    return f"error: {where}{': ' if where else ''}{fault.message} [{fault.code}]"


def input_errors(faults: Sequence[Fault], as_json: bool) -> int:
    """Reports faults of the input as the other commands do."""
    options = ("sweep", "samples", "starts", "seed", "workers", "dask")
    places = [("--" if fault.where.split("/")[0] in options else "") + fault.where for fault in faults]
    if as_json:
        put_errors([dataclasses.replace(fault, where=where) for where, fault in zip(places, faults)])
    else:
        for where, fault in zip(places, faults):
            say(error_line(where, fault))
    return EXIT_BAD_INPUT


def internal_error(fault: Exception, as_json: bool) -> int:
    """Reports a fault of this program as the other commands do."""
    message = f"{type(fault).__name__}: {fault}"
    if as_json:
        put_errors([Fault("internal", "", message)])
    else:
        say(f"fettle: internal error, please report it: {message}")
    return EXIT_INTERNAL


def put_errors(faults: Sequence[Fault]) -> None:
    put_json({"status": "error", "errors": [dataclasses.asdict(fault) for fault in faults]})


def put_json(answer: Dict[str, Any]) -> None:
    """Bytes of a path that are no text are ? there."""
    text = json.dumps(answer, ensure_ascii=False, allow_nan=False).encode("utf-8", "replace")
    put(json.dumps(json.loads(text)).replace("##[", "#\\u0023["))


class _AnswerLost(Exception):
    """Standard output does not take it."""


def put(text: str) -> None:
    if sys.stdout is None:  # closed
        raise _AnswerLost(os.strerror(errno.EBADF))
    try:
        print(text, flush=True)
    except OSError as fault:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # the interpreter tries once more at its end
        raise _AnswerLost(fault.strerror) from fault


class Stopped(KeyboardInterrupt):
    """Ctrl-C or SIGTERM."""

    came: Optional[int] = None  # the first one's number; libraries, and Python in its finalisers, drop what is raised there

    def __init__(self, number: int):
        super().__init__(number)
        self.number = number

    @classmethod
    def check(cls) -> None:
        """Raises it again if one came."""
        if cls.came is not None:
            raise cls(cls.came)


def stop_on_signals() -> None:
    """The first Ctrl-C (or SIGTERM) ends the work with what it has, a second one ends it at once. Those that came while Python started were
    held back by the program that started it."""

    def stop(number: int, _: Any) -> NoReturn:
        signal.signal(number, signal.SIG_DFL)
        Stopped.came = number
        raise Stopped(number)

    def tell_unless_stopped(dropped: Any) -> None:
        if not isinstance(dropped.exc_value, Stopped):
            sys.__unraisablehook__(dropped)

    sys.unraisablehook = tell_unless_stopped
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, stop)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, (signal.SIGINT, signal.SIGTERM))


def interrupted(options: argparse.Namespace, number: int) -> int:
    """What has been found, and how to go on."""
    results, best = 0, None
    with contextlib.suppress(Error, OSError):
        found = read_exploration(options.out)
        results, best = len(found), next(iter(found.best()), None)
    if options.json:
        put_json({"status": "interrupted", "results": results, "best": best, "out": options.out})
    elif results:
        put(printed(f"interrupted: {results} designs are in {options.out}; the same command goes on with the others"))
    else:
        put("interrupted before the first design was done")
    return EXIT_SIGNAL + number


def main(words: Optional[Sequence[str]] = None) -> int:
    """words: None: those of the process, which is then the command's own, its signals too. As the other commands: an answer that standard
    output does not take is exit code 3."""
    try:
        return run_told(words)
    except _AnswerLost as fault:
        say(error_line("standard output", Fault("file_unwritable", "", f"the answer cannot be written: {fault}")))
        return EXIT_BAD_INPUT


def run_told(words: Optional[Sequence[str]]) -> int:
    given = sys.argv[1:] if words is None else list(words)
    as_json = "--json" in given
    options = argparse.Namespace(out="", json=as_json)
    try:
        if words is None:
            stop_on_signals()
        options = arguments().parse_args(given)
        return run(options)
    except Stopped as stopped:
        return interrupted(options, stopped.number)
    except _AnswerLost:
        raise
    except Error as fault:
        return input_errors(fault.errors, as_json)
    except MemoryError:
        message = "the request needs more memory than there is; ask for fewer designs at a time, or give the program more"
        return input_errors([Fault("out_of_memory", "memory", message)], as_json)
    except OSError as fault:
        code = "file_not_found" if isinstance(fault, FileNotFoundError) else "file_unreadable"
        return input_errors([Fault(code, str(fault.filename or ""), fault.strerror or str(fault))], as_json)
    except Exception as fault:  # of ours, or of what we use: no verdict
        return internal_error(fault, as_json)


if __name__ == "__main__":
    sys.exit(main())
