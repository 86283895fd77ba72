# SPDX-License-Identifier: MIT
"""python3 -P -m fettle explore-on-dask: what `fettle explore --dask` starts to reach a cluster (design/cli/dask_cluster.cpp). A line on stdin
says where and of which design, the others are the jobs; each result is a line on stdout. The commands themselves are the program's.
(-P: without it Python takes modules from the current folder first, whatever lies there.)"""
import json
import pickle
import sys
from typing import Any, Dict

from . import _fettle
from .errors import Error
from .exploration import _dask_client, run_job, run_on_dask


def put(answer: Dict[str, Any]) -> None:
    print(json.dumps(answer), flush=True)


def main() -> int:
    if sys.argv[1:] != ["explore-on-dask"]:
        print("the commands are the program's: fettle --help", file=sys.stderr)
        return 3
    request = json.loads(sys.stdin.readline())
    try:
        design = _fettle.read_design(request["design"], request["mesh_dirs"], allow_programs=request["allow_programs"]).design
        client = _dask_client(request["address"])
    except Error as fault:
        put({"where": "--dask" if fault.where == "dask" else fault.where, "error": fault.errors[0].message})
        return 3
    with client:
        put({"connected": True})
        jobs = [_fettle._ExplorationJob(each["kind"], each["point"], each["seed"]) for each in map(json.loads, sys.stdin)]
        for job, line in run_on_dask(client, run_job, ("", pickle.dumps(design)), jobs):
            print(line or json.dumps({"key": job.key}), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
