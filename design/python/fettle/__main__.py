# SPDX-License-Identifier: MIT
"""python3 -m fettle explore DESIGN --out FILE: explores a design space from the command line. The other commands are the program's."""
import argparse
import json
import math
import sys
from typing import Any, Dict, List, NoReturn, Optional, Sequence, Union

from . import _fettle
from .errors import Error, Fault
from .exploration import explore, swept_faults

EXIT_DONE, EXIT_VIOLATED, EXIT_BAD_INPUT = 0, 1, 3
FORMS = "NAME=COUNT or NAME=LOW:HIGH:COUNT is wanted"


class Parser(argparse.ArgumentParser):
    """One whose errors are those of the other commands."""

    def error(self, message: str) -> NoReturn:
        raise Error([Fault("unsupported", "command line", f"{message}; see fettle explore --help")])


def swept(text: str, design: Any) -> Dict[str, Union[int, List[float]]]:
    """Of NAME=COUNT, or NAME=LOW:HIGH:COUNT in the parameter's own unit: {name: count, or values in SI}."""
    name, _, values = text.rpartition("=")
    where = f"--sweep {text}"
    parts = values.split(":")
    if not name or len(parts) not in (1, 3):
        raise Error([Fault("parse", where, FORMS)])
    try:
        count, ends = int(parts[-1]), [float(end) for end in parts[:-1]]
    except ValueError as fault:
        raise Error([Fault("parse", where, f"{FORMS}, with numbers: {fault}")]) from fault
    if count < 1:
        raise Error([Fault("out_of_range", where, f"{count} values are not allowed: 1 or more are")])
    if not all(map(math.isfinite, ends)):
        raise Error([Fault("not_finite", where, "both ends are finite numbers")])
    faults = swept_faults([p.name for p in design.parameters], {name: count})
    if faults:
        raise Error([Fault(fault.code, where, fault.message) for fault in faults])
    if not ends:
        return {name: count}
    unit = next(p.unit for p in design.parameters if p.name == name)
    low, high = (_fettle.to_si(end, unit) if unit else end for end in ends)
    return {name: [low + (high - low) * k / max(1, count - 1) for k in range(count)]}


def sweep_of(texts: Sequence[str], design: Any) -> Dict[str, Union[int, List[float]]]:
    """Of all --sweep. Raises Error with every fault that was found."""
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
    told = result.get("reason", "") if objective is None else f"objective {objective:.6g}"
    return f"{done}/{of} {result['status']}{': ' if told else ''}{told}"


def run(options: argparse.Namespace) -> int:
    def tell(done: int, of: int, result: Dict[str, Any]) -> None:
        if not options.quiet:
            print(progress_line(done, of, result), file=sys.stderr)

    design = _fettle.read_design(options.design, allow_programs=options.allow_programs).design
    sweep = sweep_of(options.sweep, design)
    if not sweep and options.samples == 0 and options.starts == 0:
        raise Error([Fault("missing_key", "command line", "nothing to explore: give --sweep, --samples or --starts")])
    found = explore(
        design,
        options.out,
        sweep=sweep,
        samples=options.samples,
        starts=options.starts,
        seed=options.seed,
        workers=options.workers,
        dask=options.dask,
        progress=tell,
    )
    best = next(iter(found.best()), None)
    if options.json:
        print(json.dumps({"status": "ok" if best else "infeasible", "results": len(found), "best": best, "out": options.out}))
    else:
        told = f"the best has the objective {best['objective']:.6g}" if best else "none meets every requirement"
        print(f"{len(found)} designs in {options.out}; {told}")
    return EXIT_DONE if best else EXIT_VIOLATED


def input_errors(faults: Sequence[Fault], as_json: bool) -> int:
    """As the other commands tell them."""
    options = ("sweep", "samples", "starts", "seed", "workers", "dask")
    places = [("--" if fault.where.split("/")[0] in options else "") + fault.where for fault in faults]
    if as_json:
        errors = [{"code": fault.code, "where": where, "message": fault.message} for where, fault in zip(places, faults)]
        print(json.dumps({"status": "error", "errors": errors}))
    else:
        for where, fault in zip(places, faults):
            print(f"error: {where}{': ' if where else ''}{fault.message} [{fault.code}]", file=sys.stderr)
    return EXIT_BAD_INPUT


def main(words: Optional[Sequence[str]] = None) -> int:
    given = sys.argv[1:] if words is None else list(words)
    as_json = "--json" in given
    try:
        return run(arguments().parse_args(given))
    except Error as fault:
        return input_errors(fault.errors, as_json)
    except OSError as fault:
        code = "file_not_found" if isinstance(fault, FileNotFoundError) else "file_unreadable"
        return input_errors([Fault(code, str(fault.filename or ""), fault.strerror or str(fault))], as_json)


if __name__ == "__main__":
    sys.exit(main())
