# SPDX-License-Identifier: MIT
"""python3 -m fettle explore DESIGN --out FILE: explores a design space from the command line. The other commands are the program's."""
import argparse
import json
import sys
from typing import Any, Dict, List, Optional, Sequence, Tuple, Union

from . import _fettle
from .errors import Error
from .exploration import explore

EXIT_DONE, EXIT_VIOLATED, EXIT_BAD_INPUT = 0, 1, 3


def swept(text: str) -> Tuple[str, Union[int, str]]:
    """NAME=COUNT, or NAME=LOW:HIGH:COUNT in the parameter's own unit."""
    name, _, values = text.rpartition("=")
    if not name or not values:
        raise argparse.ArgumentTypeError(f"{text!r} is not NAME=COUNT or NAME=LOW:HIGH:COUNT")
    return name, int(values) if values.isdigit() else values


def in_si(design: Any, name: str, values: Union[int, str]) -> Union[int, List[float]]:
    if isinstance(values, int):
        return values
    unit = next((p.unit for p in design.parameters if p.name == name), "")
    low, high, count = values.split(":")
    ends = [_fettle.to_si(float(end), unit) if unit else float(end) for end in (low, high)]
    n = int(count)
    return [ends[0] + (ends[1] - ends[0]) * k / max(1, n - 1) for k in range(n)]


def arguments() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="fettle", description="fettle: exploring a design space")
    commands = parser.add_subparsers(dest="command", required=True)
    command = commands.add_parser("explore", help="many designs or starts in parallel, results as JSON lines")
    command.add_argument("design", metavar="DESIGN")
    command.add_argument("--out", required=True, help="file of the results; an exploration that is there goes on")
    command.add_argument("--sweep", type=swept, action="append", default=[], metavar="NAME=COUNT", help="or NAME=LOW:HIGH:COUNT, in its unit")
    command.add_argument("--samples", type=int, default=0, help="so many designs, drawn from the bounds")
    command.add_argument("--starts", type=int, default=0, help="so many runs of the optimiser")
    command.add_argument("--seed", type=int, default=1)
    command.add_argument("--workers", type=int, help="processes (default: the processors)")
    command.add_argument("--dask", metavar="ADDRESS", help="of a running Dask scheduler")
    command.add_argument("--allow-programs", action="store_true", help="run the programs that a scene names to make its parts")
    command.add_argument("--json", action="store_true", help="one JSON object on stdout and nothing else there")
    command.add_argument("--quiet", action="store_true")
    return parser


def main(words: Optional[Sequence[str]] = None) -> int:
    options = arguments().parse_args(words)

    def tell(done: int, of: int, result: Dict[str, Any]) -> None:
        if not options.quiet:
            print(f"{done}/{of} {result['status']} {result.get('objective')}", file=sys.stderr)

    try:
        design = _fettle.read_design(options.design, allow_programs=options.allow_programs).design
        sweep = {name: in_si(design, name, values) for name, values in options.sweep}
        if not sweep and options.samples <= 0 and options.starts <= 0:
            raise ValueError("nothing to explore: give --sweep, --samples or --starts")
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
    except (Error, ValueError, OSError) as fault:
        print(f"error: {fault}", file=sys.stderr)
        if options.json:
            print(json.dumps({"status": "error", "errors": [{"code": "inconsistent", "where": options.design, "message": str(fault)}]}))
        return EXIT_BAD_INPUT
    best = found.best()
    if options.json:
        print(json.dumps({"status": "ok" if best else "infeasible", "results": len(found), "best": best[0] if best else None, "out": options.out}))
    else:
        print(f"{len(found)} designs in {options.out}; " + (f"the best has the objective {best[0]['objective']:.6g}" if best else "none meets every requirement"))
    return EXIT_DONE if best else EXIT_VIOLATED


if __name__ == "__main__":
    sys.exit(main())
