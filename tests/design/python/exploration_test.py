# SPDX-License-Identifier: MIT
"""Exploring a design space: sweeps, samples, starts; resumed, with lost workers, on a Dask cluster."""
import json
import os
import pathlib
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import fettle
from conftest import EXAMPLES, MeanHeight, tilted_plate

HERE = pathlib.Path(__file__).resolve().parent


class Deadly(MeanHeight):
    """Ends its process the first time that it is measured, or every time at a certain speed."""

    def __init__(self, marker, always=None):
        super().__init__(1)
        self.marker, self.always = marker, always

    def value(self, simulated):
        if self.always is not None and abs(simulated.rotations[1, 0, 0, 2] - self.always) < 1e-12:
            os.kill(os.getpid(), signal.SIGKILL)
        try:
            os.close(os.open(self.marker, os.O_CREAT | os.O_EXCL))
        except FileExistsError:
            return super().value(simulated)
        os.kill(os.getpid(), signal.SIGKILL)
        raise AssertionError("still alive")


def short_design(quantity=None):
    design = tilted_plate(quantity)
    design.steps = 2
    return design


def test_a_sweep_and_what_can_be_asked_of_it(tmp_path):
    out = str(tmp_path / "sweep.jsonl")
    told = []
    sweep = {"height": 3, "speed": [0.3, 0.5]}
    found = fettle.explore(short_design(), out, sweep=sweep, workers=2, progress=lambda *at: told.append(at))
    assert len(found) == 6 and told[-1][:2] == (6, 6)
    assert sorted(set(found.column("speed"))) == [0.3, 0.5]
    assert sorted(set(found.column("height"))) == pytest.approx([6e-3, 9e-3, 12e-3])
    problem = fettle.DesignProblem(short_design())
    for result in found.results:
        p = np.array([result["parameters"][name] for name in problem.parameter_names])
        assert result["objective"] == problem.value(p)  # the same bits as alone
    best = found.best(2)
    assert best[0]["objective"] <= best[1]["objective"]
    assert all(r["violation"] == 0 for r in best)
    assert len(found.where(lambda r: r["parameters"]["speed"] == 0.3)) == 3
    # What is there is not computed again; what is new, is.
    before = pathlib.Path(out).read_text()
    assert len(fettle.explore(short_design(), out, sweep=sweep)) == 6
    assert pathlib.Path(out).read_text() == before
    assert len(fettle.explore(short_design(), out, samples=2, workers=1)) == 8
    with pytest.raises(fettle.Error, match="another design"):
        fettle.explore(tilted_plate(), out, samples=1)


def test_a_file_that_was_cut_off_goes_on(tmp_path):
    whole = str(tmp_path / "whole.jsonl")
    fettle.explore(short_design(), whole, samples=4, workers=1)
    text = pathlib.Path(whole).read_text()
    cut = tmp_path / "cut.jsonl"
    cut.write_text(text[: text.rfind("\n", 0, -1) + 30])
    assert len(fettle.read_exploration(str(cut))) == 3
    again = fettle.explore(short_design(), str(cut), samples=4, workers=1)
    expected = {r["key"]: r["objective"] for r in fettle.read_exploration(whole).results}
    assert {r["key"]: r["objective"] for r in again.results} == expected


def test_a_lost_worker_costs_its_current_design_only(tmp_path):
    design = short_design(Deadly(str(tmp_path / "marker")))
    found = fettle.explore(design, str(tmp_path / "out.jsonl"), samples=6, workers=2)
    assert (tmp_path / "marker").exists()
    assert len(found) == 6
    assert {r["status"] for r in found.results} <= {"feasible", "infeasible"}
    # A design that ends every worker is written down as lost, and the others are there.
    sure = fettle.DesignProblem(short_design())
    p = sure.values
    p[3] = 0.5
    turned = sure.evaluate(p).simulation.trajectory.rotations[1, 0, 0, 2]
    design = short_design(Deadly(str(tmp_path / "marker"), turned))
    found = fettle.explore(design, str(tmp_path / "lost.jsonl"), sweep={"speed": [0.3, 0.5, 0.7]}, workers=2)
    assert sorted(r["status"] for r in found.results).count("lost") == 1
    assert len(found) == 3


def test_starts_of_the_optimiser(tmp_path):
    design = short_design()
    design.optimiser.max_evaluations = 4
    found = fettle.explore(design, str(tmp_path / "starts.jsonl"), starts=2, workers=2)
    assert [r["seed"] for r in sorted(found.results, key=lambda r: r["seed"])] == [0, 1001]
    alone = fettle.optimise(fettle.DesignProblem(design))
    (first,) = found.where(lambda r: r["seed"] == 0)
    assert list(first["parameters"].values()) == list(alone.report.point)


def test_a_design_that_raises_is_told(tmp_path):
    class_in_no_module = type("Broken", (MeanHeight,), {})
    with pytest.raises(Exception, match="Broken|pickle"):
        fettle.explore(short_design(class_in_no_module(1)), str(tmp_path / "a.jsonl"), samples=1)


def test_the_command(tmp_path):
    text = (EXAMPLES / "slider_crank" / "slider_crank.design.json").read_text()
    scene = EXAMPLES / "slider_crank" / "slider_crank.scene.json"
    design = tmp_path / "short.design.json"
    design.write_text(text.replace('"scene": "slider_crank.scene.json"', f'"scene": "{scene}", "simulation": {{"steps": 1}}'))
    out = tmp_path / "sweep.jsonl"
    words = ["explore", str(design), "--out", str(out), "--sweep", "crank_radius=13:14:3", "--workers", "1", "--quiet", "--json"]
    done = subprocess.run([sys.executable, "-m", "fettle", *words], capture_output=True, text=True, check=False)
    assert done.returncode == 1, done.stderr  # the stroke is not met in one step
    answer = json.loads(done.stdout)
    assert answer["results"] == 3 and answer["best"] is None
    assert sorted(fettle.read_exploration(str(out)).column("crank_radius")) == pytest.approx([13e-3, 13.5e-3, 14e-3])
    wrong = subprocess.run([sys.executable, "-m", "fettle", "explore", str(design), "--out", str(out)], capture_output=True, text=True, check=False)
    assert wrong.returncode == 3 and "nothing to explore" in wrong.stderr


@pytest.fixture(name="cluster")
def cluster_fixture(tmp_path):
    """A scheduler and two workers on the loopback, started as Dask's documentation says."""
    pytest.importorskip("distributed")
    paths = [str(HERE), *os.environ.get("PYTHONPATH", "").split(os.pathsep)]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths), "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "1"}
    place = tmp_path / "scheduler.json"

    def start(*words):
        return subprocess.Popen([sys.executable, "-m", *words], env=environment, cwd=tmp_path, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    started = [start("distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", str(place))]
    for _ in range(300):
        if place.exists() and place.read_text().strip():
            break
        time.sleep(0.1)
    worker = ("distributed.cli.dask_worker", "--scheduler-file", str(place), "--nthreads", "1", "--no-nanny", "--no-dashboard")
    started += [start(*worker), start(*worker)]
    yield json.loads(place.read_text())["address"], started[1:]
    for process in started:
        process.kill()
        process.wait()


@pytest.mark.programs
def test_on_a_dask_cluster_one_of_whose_workers_is_killed(tmp_path, cluster):
    address, workers = cluster
    design = short_design(Deadly(str(tmp_path / "marker")))
    found = fettle.explore(design, str(tmp_path / "dask.jsonl"), samples=8, dask=address)
    assert (tmp_path / "marker").exists()
    assert sorted(worker.poll() is not None for worker in workers) == [False, True]  # one was killed, by its design
    assert len(found) == 8
    assert {r["status"] for r in found.results} <= {"feasible", "infeasible"}
    local = fettle.explore(short_design(MeanHeight(1)), str(tmp_path / "local.jsonl"), samples=8, workers=1)
    assert {r["key"]: r["objective"] for r in found.results} == {r["key"]: r["objective"] for r in local.results}
