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
from fettle import exploration
from fettle.__main__ import main, progress_line

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


def short_file(tmp_path):
    text = (EXAMPLES / "slider_crank" / "slider_crank.design.json").read_text()
    scene = EXAMPLES / "slider_crank" / "slider_crank.scene.json"
    design = tmp_path / "short.design.json"
    design.write_text(text.replace('"scene": "slider_crank.scene.json"', f'"scene": "{scene}", "simulation": {{"steps": 1}}'))
    return design


def test_the_command(tmp_path):
    design = short_file(tmp_path)
    out = tmp_path / "sweep.jsonl"
    words = ["explore", str(design), "--out", str(out), "--sweep", "crank_radius=13:14:3", "--workers", "1", "--quiet", "--json"]
    done = subprocess.run([sys.executable, "-m", "fettle", *words], capture_output=True, text=True, check=False)
    assert done.returncode == 1, done.stderr  # the stroke is not met in one step
    answer = json.loads(done.stdout)
    assert answer["results"] == 3 and answer["best"] is None
    assert sorted(fettle.read_exploration(str(out)).column("crank_radius")) == pytest.approx([13e-3, 13.5e-3, 14e-3])
    wrong = subprocess.run([sys.executable, "-m", "fettle", "explore", str(design), "--out", str(out)], capture_output=True, text=True, check=False)
    assert wrong.returncode == 3 and "nothing to explore" in wrong.stderr


def told(capsys, *words):
    """Exit code, and the errors of the command as (code, where, message)."""
    code = main(["explore", *map(str, words), "--json"])
    answer = json.loads(capsys.readouterr().out)
    return code, [(e["code"], e["where"], e["message"]) for e in answer.get("errors", ())]


def test_the_commands_errors_have_code_and_place(tmp_path, capsys):
    design, out = short_file(tmp_path), tmp_path / "out.jsonl"
    sweeps = [
        ("crank_radius=abc", "parse", "NAME=COUNT or NAME=LOW:HIGH:COUNT"),
        ("crank_radius=1:2", "parse", "NAME=LOW:HIGH:COUNT"),
        ("=3", "parse", "NAME=COUNT"),
        ("crank_radius", "parse", "NAME=COUNT"),
        ("crank_radius=-3", "out_of_range", "1 or more"),
        ("crank_radius=0", "out_of_range", "1 or more"),
        ("crank_radius=13:14:0", "out_of_range", "1 or more"),
        ("crank_radius=nan:14:2", "not_finite", "finite"),
        ("crank_radus=3", "unknown_key", "did you mean 'crank_radius'?"),
        ("crank_radius=9999999999", "out_of_range", "up to 1000000"),
    ]
    for sweep, code, words in sweeps:
        ended, ((found, where, message),) = told(capsys, design, "--out", out, "--sweep", sweep)
        assert (ended, found, where) == (3, code, f"--sweep {sweep}"), message
        assert words in message
    all_of_them = [word for sweep, _, _ in sweeps for word in ("--sweep", sweep)]
    assert len(told(capsys, design, "--out", out, *all_of_them)[1]) == len(sweeps)
    others = [
        (["--sweep", "crank_radius=2", "--sweep", "crank_radius=3"], "inconsistent", "--sweep crank_radius=3"),
        (["--samples", "-1"], "out_of_range", "--samples"),
        (["--samples", "1", "--workers", "0"], "out_of_range", "--workers"),
        (["--samples", "1", "--seed", "-1"], "out_of_range", "--seed"),
        (["--samples", "many"], "unsupported", "command line"),
        ([], "missing_key", "command line"),
    ]
    for words, code, where in others:
        ended, ((found, place, message),) = told(capsys, design, "--out", out, *words)
        assert (ended, found, place) == (3, code, where), message
    assert not out.exists()
    assert told(capsys, tmp_path / "none.json", "--out", out, "--samples", 1)[1][0][:2] == ("file_not_found", str(tmp_path / "none.json"))
    nowhere = tmp_path / "none" / "out.jsonl"
    assert told(capsys, design, "--out", nowhere, "--samples", 1)[1][0][:2] == ("file_not_found", str(nowhere))
    # As text: a line each, as the other commands have it.
    assert main(["explore", str(design), "--out", str(out), "--sweep", "crank_radius=0"]) == 3
    assert capsys.readouterr().err == "error: --sweep crank_radius=0: 0 values are not allowed: 1 or more are [out_of_range]\n"


def test_what_is_no_exploration_is_left_alone(tmp_path, capsys):
    design = short_file(tmp_path)
    for text in (b'{"a": 1}', b"a line\nand more", b"\xff\xfe"):
        other = tmp_path / "other.txt"
        other.write_bytes(text)
        ended, ((code, where, _),) = told(capsys, design, "--out", other, "--samples", 1)
        assert (ended, code, where) == (3, "parse", str(other))
        assert other.read_bytes() == text


def test_progress_says_why(tmp_path):
    design = short_design()
    design.parameters[1].lower = -1e-3
    lines = []
    sweep = {"foot": [-1e-3, 8e-3]}
    found = fettle.explore(design, str(tmp_path / "a.jsonl"), sweep=sweep, workers=1, progress=lambda *at: lines.append(progress_line(*at)))
    assert lines[0].startswith("1/2 unusable: ") and "above 0" in lines[0]
    assert "objective -" in lines[1]
    assert repr(found) == f"Exploration(2 designs: 1 unusable, 1 {found.results[1]['status']})"


def test_what_is_raised_leaves_no_file(tmp_path):
    out = tmp_path / "out.jsonl"

    def enough(*_):
        raise KeyError("enough")

    faults = {"samples": -1, "starts": -1, "seed": -1, "workers": 0}
    with pytest.raises(fettle.Error) as refused:
        fettle.explore(short_design(), str(out), sweep={"height": 0, "speed": [0.3, float("inf")], "hight": 2}, **faults)
    assert [e.where for e in refused.value.errors] == [*faults, "sweep/height", "sweep/speed", "sweep/hight"]
    assert not out.exists()
    with pytest.raises(KeyError, match="enough"):
        fettle.explore(short_design(), str(out), samples=2, workers=1, progress=enough)
    assert len(fettle.read_exploration(str(out))) == 1  # what was found stays


def test_an_address_where_no_scheduler_is(tmp_path, capsys, monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setattr(exploration, "DASK_SECONDS", 1)
    design, out = short_file(tmp_path), tmp_path / "out.jsonl"
    for address, code, words in (
        ("foo", "parse", "no address"),
        ("tcp://", "parse", "no address"),
        ("foo://host:1", "parse", "no address"),
        ("tcp://127.0.0.1:1", "file_not_found", "within 1 s"),
    ):
        begin = time.monotonic()
        ended, ((found, where, message),) = told(capsys, design, "--out", out, "--samples", 1, "--dask", address)
        assert (ended, found, where) == (3, code, "--dask") and words in message
        assert time.monotonic() - begin < 10
        assert not out.exists()


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
