# SPDX-License-Identifier: MIT
"""How a design's numbers spread when its parts are made, with samples on threads of this machine or on a Dask cluster.

    report = fettle.tolerance("hinge.design.json", samples=2000, samples_file="made.jsonl", workers=8)
    report = fettle.tolerance("hinge.design.json", samples=2000, dask="tcp://10.0.0.5:8786")

Sample k is the same, bit for bit, whoever makes it, and so is the report.
"""
import contextlib
import os
import pickle
import tempfile
from typing import Any, Callable, Dict, Optional, Sequence

from . import _fettle
from ._calls import in_plain_words
from .errors import Error, Fault
from .exploration import _dask_client, make_sample, run_on_dask
from .results import ToleranceReport
from .scene import PathLike

Progress = Callable[[int, int], object]
_tolerance = in_plain_words(_fettle.tolerance)


def _after(done_before: int, progress: Progress) -> Progress:
    return lambda done, of: progress(done_before + done, done_before + of)


def tolerance(
    path: PathLike,
    samples: int = 0,
    seed: int = 1,
    second_order: bool = True,
    worst_case: bool = False,
    samples_file: str = "",
    process: str = "",
    mesh_dirs: Sequence[PathLike] = (),
    allow_programs: bool = False,
    progress: Optional[Progress] = None,
    *,
    workers: Optional[int] = None,
    dask: Optional[str] = None,
) -> ToleranceReport:
    """What becomes of a *.design.json with `tolerances` when its parts are made, as `fettle tolerance` answers: a ToleranceReport.

    samples_file: samples that it has are not simulated again. process: what makes the parts, in place of the design's. progress(done, of).
    workers: how many samples at once (default: one for each processor). dask: address of a scheduler, whose workers are used instead, and
    which find the design's files at the same path; whoever reaches it can run code on its workers, and here. Predictions are made in this
    process. The report is the same, bit for bit, whoever makes the samples."""
    given: Dict[str, Any] = {
        "path": path,
        "samples": samples,
        "seed": seed,
        "second_order": second_order,
        "worst_case": worst_case,
        "process": process,
        "mesh_dirs": list(mesh_dirs),
        "allow_programs": allow_programs,
    }
    if workers is not None and workers < 1:
        raise Error([Fault("out_of_range", "workers", f"{workers} is not allowed: 1 or more is")])
    if dask is None or not samples > 0:
        limit = None if workers is None else _fettle.ThreadLimit(workers)
        report = _tolerance(samples_file=samples_file, progress=progress, **given)
        del limit
        return report
    with contextlib.ExitStack() as stack:
        client = stack.enter_context(_dask_client(dask))
        if not samples_file:
            samples_file = os.path.join(stack.enter_context(tempfile.TemporaryDirectory(prefix="fettle_")), "samples.jsonl")
        arguments = (os.path.abspath(path), seed, process, [os.path.abspath(each) for each in mesh_dirs], allow_programs)
        shared = _fettle.SharedSamples(*arguments)
        stack.callback(shared.close)
        missing = shared.open(samples_file, samples)
        to_do = 1 + (2 * shared.tolerance_count if second_order else 0)
        for done, (sample, line) in enumerate(run_on_dask(client, make_sample, (shared.name, pickle.dumps(arguments)), missing), 1):
            if line is None:
                raise Error([Fault("internal", f"sample {sample}", "two workers were lost on it")])
            shared.keep(line)
            if progress:
                progress(done, len(missing) + to_do)
        shared.close()
        count = None if progress is None else _after(len(missing), progress)
        report = _tolerance(samples_file=samples_file, progress=count, **given)
    return report
