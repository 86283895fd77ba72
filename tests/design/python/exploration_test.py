# SPDX-License-Identifier: MIT
"""Exploring a design space: sweeps, samples, starts; resumed, with lost workers, on a Dask cluster."""
import json
import os
import pathlib
import resource
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import fettle
from conftest import EXAMPLES, MeanHeight, tilted_plate
from fettle import exploration

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


def test_starts_of_the_optimiser(tmp_path):
    design = short_design()
    design.optimiser.max_evaluations = 4
    found = fettle.explore(design, str(tmp_path / "starts.jsonl"), starts=2, workers=2)
    assert [r["seed"] for r in sorted(found.results, key=lambda r: r["seed"])] == [0, 1001]
    alone = fettle.optimise(fettle.DesignProblem(design))
    (first,) = found.where(lambda r: r["seed"] == 0)
    assert list(first["parameters"].values()) == list(alone.report.point)


class Raising(MeanHeight):
    """Raises where it is measured."""

    def value(self, simulated):
        raise ZeroDivisionError("by nothing")


def test_a_design_that_raises_is_told(tmp_path):
    found = fettle.explore(short_design(Raising(1)), str(tmp_path / "a.jsonl"), samples=2)
    assert [r["status"] for r in found.results] == ["failed", "failed"]
    assert all("by nothing" in r["reason"] for r in found.results)
    class_in_no_module = type("Broken", (MeanHeight,), {})
    with pytest.raises(Exception, match="Broken|pickle"):  # the design has no name that another run would find again
        fettle.explore(short_design(class_in_no_module(1)), str(tmp_path / "b.jsonl"), samples=1)


def short_file(tmp_path):
    text = (EXAMPLES / "slider_crank" / "slider_crank.design.json").read_text()
    scene = EXAMPLES / "slider_crank" / "slider_crank.scene.json"
    design = tmp_path / "short.design.json"
    design.write_text(text.replace('"from": 0.1, ', "").replace('"scene": "slider_crank.scene.json"', f'"scene": "{scene}", "simulation": {{"steps": 1}}'))
    return design


# The program, where it was built beside the package.
PROGRAM = pathlib.Path(fettle.__file__).parents[2] / "bin" / "fettle"
needs_program = pytest.mark.skipif(not PROGRAM.exists(), reason="the program was not built beside the package")


def ran(*words, **options):
    return subprocess.run([PROGRAM, "explore", *map(str, words)], capture_output=True, text=True, check=False, **options)


@needs_program
def test_the_command(tmp_path):
    design = short_file(tmp_path)
    out = tmp_path / "sweep.jsonl"
    done = ran(design, "--out", out, "--sweep", "crank_radius=13:14:3", "--workers", "1", "--quiet", "--json")
    assert done.returncode == 1, done.stderr  # the stroke is not met in one step
    answer = json.loads(done.stdout)
    assert answer["results"] == 3 and answer["best"] is None
    assert sorted(fettle.read_exploration(str(out)).column("crank_radius")) == pytest.approx([13e-3, 13.5e-3, 14e-3])
    assert fettle.read_exploration(str(out)).header["file"] == "short.design.json"  # from its folder, so that its report finds it
    before = out.read_text()
    assert len(fettle.explore(design, out, sweep={"crank_radius": ["13mm", "13.5mm", "14mm"]})) == 3  # the same file, the same jobs
    assert out.read_text() == before
    wrong = ran(design, "--out", out)
    assert wrong.returncode == 3 and "nothing to explore" in wrong.stderr


def hostile_folder(place):
    """A folder whose modules are called as those that an exploration imports; each leaves its name in `place` when it is run."""
    place.mkdir()
    loud = f"import pathlib\npathlib.Path({str(place / 'seen')!r}).open('a').write(__name__ + ' ')\nraise SystemExit('caught')\n"
    for name in ("argparse", "numpy", "json", "pickle", "multiprocessing", "signal", "sitecustomize", "usercustomize", "distributed", "random"):
        (place / f"{name}.py").write_text(loud)
    for name in ("fettle", "encodings"):
        (place / name).mkdir()
        (place / name / "__init__.py").write_text(loud)
    return place


@needs_program
@pytest.mark.programs
def test_the_current_folder_is_no_place_of_modules(tmp_path):
    """Of the Python that reaches a cluster."""
    pytest.importorskip("distributed")
    design = short_file(tmp_path)
    place = hostile_folder(tmp_path / "hostile")
    for number, given in enumerate((None, "", ":", f":{tmp_path}:", ".", "../hostile")):
        environment = {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "PYTHONSAFEPATH")}
        environment.update({} if given is None else {"PYTHONPATH": given})
        done = ran(design, "--out", f"{number}.jsonl", "--samples", "1", "--dask", "nowhere", cwd=place, env=environment)
        assert not (place / "seen").exists(), (given, (place / "seen").read_text())
        assert done.returncode == 3 and "is no address of a scheduler" in done.stderr


def interrupted_exploration(words, cwd, when, number=signal.SIGINT):
    """(exit code, stdout, stderr) of a command whose whole group gets a signal, as by a terminal, once `when()`."""
    with subprocess.Popen(words, cwd=cwd, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True) as process:
        deadline = time.monotonic() + 60
        while not when() and process.poll() is None and time.monotonic() < deadline:
            time.sleep(0.01)
        os.killpg(process.pid, number)
        try:
            out, err = process.communicate(timeout=60)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            raise
    return process.returncode, out, err


@needs_program
@pytest.mark.parametrize("number", (signal.SIGINT, signal.SIGTERM))
def test_ctrl_c_keeps_what_was_done_and_says_how_to_go_on(tmp_path, number):
    design, out = short_file(tmp_path), tmp_path / "out.jsonl"
    samples = 100_000
    words = [str(PROGRAM), "explore", str(design), "--out", str(out), "--samples", str(samples), "--workers", "2", "--quiet"]
    code, said, err = interrupted_exploration(words, tmp_path, lambda: out.exists() and out.read_text().count("\n") > 2, number)
    done = len(fettle.read_exploration(str(out)))
    assert (code, err) == (2, "")
    assert said.startswith(f"interrupted: {done} designs in {out}; ") and said.endswith("the same command goes on with the others\n")
    assert 2 <= done < samples
    # Again, now told as JSON: it goes on.
    code, said, err = interrupted_exploration([*words, "--json"], tmp_path, lambda: out.read_text().count("\n") > done + 2, number)
    answer = json.loads(said)
    assert (code, err) == (2, "")
    assert answer["status"] == "interrupted" and answer["results"] == len(fettle.read_exploration(str(out))) > done


@needs_program
def test_ctrl_c_at_any_time_is_no_traceback(tmp_path):
    design, out = short_file(tmp_path), tmp_path / "out.jsonl"
    words = [str(PROGRAM), "explore", str(design), "--out", str(out), "--samples", "100000", "--workers", "2", "--quiet"]
    for pause in (0.02, 0.1, 0.2, 0.4):
        end = time.monotonic() + pause
        code, said, err = interrupted_exploration(words, tmp_path, lambda: time.monotonic() > end)
        if code == -signal.SIGINT:  # it came before the program had begun
            assert pause == 0.02
            continue
        assert (code, err) == (2, ""), pause
        assert said.startswith("interrupted"), pause


def test_ctrl_c_while_a_record_is_read_is_not_dropped():
    """A flag of the interpreter becomes an exception wherever Python code runs next: also where a member that may be absent is asked for."""

    class InterruptedPath:
        @property
        def __fspath__(self):
            raise KeyboardInterrupt

    class InterruptedDesign(fettle.Design):
        @property
        def _prepared(self):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fettle.read_scene(InterruptedPath())
    with pytest.raises(KeyboardInterrupt):
        fettle.DesignProblem(InterruptedDesign())


def told(*words):
    """Exit code, and the errors of the command as (code, where, message)."""
    done = ran(*words, "--json")
    return done.returncode, [(e["code"], e["where"], e["message"]) for e in json.loads(done.stdout).get("errors", ())]


@needs_program
def test_the_commands_errors_have_code_and_place(tmp_path):
    design, out = short_file(tmp_path), tmp_path / "out.jsonl"
    sweeps = [
        ("crank_radius=abc", "parse", "NAME=COUNT or NAME=LOW:HIGH:COUNT is expected; COUNT is a whole number, found 'abc'"),
        ("crank_radius=2.5", "parse", "COUNT is a whole number, found '2.5'"),
        ("crank_radius=1mm:2mm:3", "parse", "LOW is a number, in the parameter's own unit and without it, found '1mm'"),
        ("crank_radius=1:2", "parse", "NAME=LOW:HIGH:COUNT"),
        ("=3", "parse", "NAME=COUNT"),
        ("crank_radius", "parse", "NAME=COUNT"),
        ("crank_radius=-3", "out_of_range", "1 or more"),
        ("crank_radius=0", "out_of_range", "1 or more"),
        ("crank_radius=13:14:0", "out_of_range", "1 or more"),
        ("crank_radius=nan:14:2", "not_finite", "finite"),
        ("crank_radius=13:900:3", "out_of_range", "900 mm is far outside the bounds, "),
        ("crank_radus=3", "unknown_key", "did you mean 'crank_radius'?"),
        ("crank_radius=9999999999", "out_of_range", "up to 1000000"),
    ]
    for sweep, code, words in sweeps:
        ended, ((found, where, message),) = told(design, "--out", out, "--sweep", sweep)
        assert (ended, found, where) == (3, code, f"--sweep {sweep}"), message
        assert words in message
    all_of_them = [word for sweep, _, _ in sweeps for word in ("--sweep", sweep)]
    assert len(told(design, "--out", out, *all_of_them)[1]) == len(sweeps)
    others = [
        (["--sweep", "crank_radius=2", "--sweep", "crank_radius=3"], "inconsistent", "--sweep crank_radius=3"),
        (["--samples", "-1"], "unsupported", "command line"),
        (["--samples", "1", "--workers", "0"], "unsupported", "command line"),
        (["--samples", "1", "--seed", "-1"], "unsupported", "command line"),
        ([], "missing_key", "command line"),
    ]
    for words, code, where in others:
        ended, ((found, place, message),) = told(design, "--out", out, *words)
        assert (ended, found, place) == (3, code, where), message
    assert not out.exists()
    assert told(tmp_path / "none.json", "--out", out, "--samples", 1)[1][0][:2] == ("file_not_found", str(tmp_path / "none.json"))
    (tmp_path / "file").write_text("")
    nowhere = tmp_path / "file" / "sub" / "out.jsonl"
    assert told(design, "--out", nowhere, "--samples", 1)[1][0][:2] == ("file_unwritable", str(nowhere.parent))
    made = tmp_path / "new" / "sub" / "out.jsonl"
    assert told(design, "--out", made, "--samples", 1, "--workers", 1)[1] == [] and made.exists()


@needs_program
def test_what_is_no_exploration_is_left_alone(tmp_path):
    design = short_file(tmp_path)
    for text in (b'{"a": 1}', b"a line\nand more", b"\xff\xfe"):
        other = tmp_path / "other.txt"
        other.write_bytes(text)
        ended, ((code, where, _),) = told(design, "--out", other, "--samples", 1)
        assert (ended, code, where) == (3, "parse", str(other))
        assert other.read_bytes() == text


def test_progress_says_why(tmp_path):
    design = short_design()
    design.parameters[1].lower = -1e-3
    lines = []
    sweep = {"foot": [-1e-3, 8e-3]}
    found = fettle.explore(design, str(tmp_path / "a.jsonl"), sweep=sweep, workers=1, progress=lambda *at: lines.append(at))
    assert lines[0][:2] == (1, 2) and lines[0][2]["status"] == "unusable" and "above 0" in lines[0][2]["reason"]
    assert lines[1] == (2, 2, found.results[1])
    assert repr(found) == f"Exploration(2 designs: 1 unusable, 1 {found.results[1]['status']})"


@needs_program
def test_the_answer_counts_the_designs_that_meet_every_requirement(tmp_path):
    out = tmp_path / "out.jsonl"
    done = ran(short_file(tmp_path), "--out", out, "--samples", "2", "--quiet")
    met = sum(json.loads(line)["violation"] <= 0 for line in out.read_text().splitlines() if '"violation"' in line)
    assert done.stdout.startswith(f"2 designs in {out}; ")
    assert (done.returncode == 0) == (met > 0)
    text = f"{met} meet{'s' if met == 1 else ''} every requirement, the best with the objective " if met else "none meets"
    assert text in done.stdout


def test_what_is_raised_leaves_no_file(tmp_path):
    out = tmp_path / "out.jsonl"

    def enough(*_):
        raise KeyError("enough")

    for name, value in {"samples": -1, "starts": -1, "seed": -1, "workers": 0}.items():
        with pytest.raises(fettle.Error) as refused:
            fettle.explore(short_design(), str(out), **{"samples": 1, name: value})
        assert [e.where for e in refused.value.errors] == [name]
    with pytest.raises(fettle.Error) as refused:
        fettle.explore(short_design(), str(out), sweep={"height": 0, "speed": [0.3, float("inf")], "hight": 2})
    assert sorted(e.where for e in refused.value.errors) == ["sweep/height", "sweep/hight", "sweep/speed"]
    assert not out.exists()
    with pytest.raises(KeyError, match="enough"):
        fettle.explore(short_design(), str(out), samples=2, workers=1, progress=enough)
    assert len(fettle.read_exploration(str(out))) == 1  # what was found stays


def test_an_address_where_no_scheduler_is(tmp_path, monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setattr(exploration, "DASK_SECONDS", 1)
    out = tmp_path / "out.jsonl"
    for address, code, words in (
        ("foo", "parse", "no address"),
        ("tcp://", "parse", "no address"),
        ("foo://host:1", "parse", "no address"),
        ("tcp://127.0.0.1:1", "file_not_found", "within 1 s"),
    ):
        begin = time.monotonic()
        with pytest.raises(fettle.Error, match=words) as refused:
            fettle.explore(short_design(), out, samples=1, dask=address)
        assert (refused.value.errors[0].code, refused.value.where) == (code, "dask")
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


@needs_program
@pytest.mark.programs
def test_the_command_on_a_dask_cluster(tmp_path, cluster):
    address, _ = cluster
    design = short_file(tmp_path)
    words = (design, "--samples", 3, "--starts", 1, "--quiet", "--json")
    shared, alone = ran(*words, "--out", tmp_path / "dask.jsonl", "--dask", address), ran(*words, "--out", tmp_path / "alone.jsonl")
    assert shared.returncode == alone.returncode == 1, shared.stderr
    found, expected = ({r["key"]: {**r, "seconds": 0} for r in fettle.read_exploration(tmp_path / name).results} for name in ("dask.jsonl", "alone.jsonl"))
    assert found == expected and len(found) == 4


@pytest.mark.programs
def test_samples_of_tolerances_on_a_dask_cluster(tmp_path, cluster):
    address, _ = cluster
    body = {"name": "block", "density": 1000, "shape": {"part": "box", "dimensions": {"size_x": 10, "size_y": 10, "size_z": 10}}}
    (tmp_path / "block.scene.json").write_text(json.dumps({"fettle_scene": 1, "units": "mm", "bodies": [body]}))
    design = {
        "fettle_design": 1,
        "scene": "block.scene.json",
        "units": "mm",
        "parameters": [{"name": "depth", "value": 10, "lower": 5, "upper": 20}],
        "set": {"/bodies/block/shape/dimensions/size_y": "= depth"},
        "objective": [{"type": "mass", "bodies": ["block"]}],
        "tolerances": {"depth": "+-0.3 mm"},
    }
    path = tmp_path / "block.design.json"
    path.write_text(json.dumps(design))
    shared = fettle.tolerance(path, samples=9, dask=address)
    assert shared.answer == fettle.tolerance(path, samples=9).answer


DAMAGED_LINES = {
    "null": "null",
    "list": "[]",
    "number": "7",
    "no key": '{"status": "feasible"}',
    "status of a number": '{"key": "k", "status": 5}',
    "objective of a text": '{"key": "k", "status": "feasible", "objective": "low"}',
    "NaN": '{"key": "k", "status": "feasible", "objective": NaN, "violation": 0}',
    "parameters of a list": '{"key": "k", "status": "feasible", "objective": 1, "violation": 0, "parameters": []}',
    "parameter of a text": '{"key": "k", "status": "feasible", "parameters": {"height": "x"}}',
    "too large": '{"key": "k", "status": "feasible", "objective": 1e999, "violation": 0}',
    "many digits": '{"key": "k", "status": "feasible", "objective": 1%s, "violation": 0}' % ("0" * 400),
    "200 deep": '{"key": "k", "status": "feasible", "note": %s1%s}' % ("[" * 200, "]" * 200),
    "100,000 deep": "[" * 100000,
    "cut off": "{broken",
}


@pytest.mark.parametrize("line", DAMAGED_LINES.values(), ids=DAMAGED_LINES.keys())
def test_a_damaged_line_is_bad_input_and_no_verdict(tmp_path, line):
    out = tmp_path / "damaged.jsonl"
    fettle.explore(short_design(), str(out), samples=1, workers=1)
    out.write_text(out.read_text() + line + "\n")
    for again in (lambda: fettle.read_exploration(str(out)), lambda: fettle.explore(short_design(), str(out), samples=1)):
        with pytest.raises(fettle.Error) as fault:
            again()
        assert fault.value.where == f"{out}:3" and "damaged" in str(fault.value)


def test_more_than_can_be_planned_is_refused_at_once(tmp_path):
    for request in ({"samples": 10**9}, {"starts": 10**9}, {"sweep": {"height": 10**9}}):
        with pytest.raises(fettle.Error, match="up to 1000000 are"):
            fettle.explore(short_design(), str(tmp_path / "many.jsonl"), **request)


@needs_program
def test_a_full_disk_costs_the_file_and_not_what_was_found(tmp_path):
    design, out = short_file(tmp_path), tmp_path / "full.jsonl"
    words = ("--out", out, "--workers", 1, "--json", "--quiet")
    first = ran(design, *words, "--samples", 1)
    assert first.returncode in (0, 1), first.stderr
    before = out.read_text()

    def full(size):  # files end at so many bytes, as on a full disk
        return {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))}

    told = ran(design, *words, "--samples", 3, **full(len(before) + 20))
    assert told.returncode == 3
    answer = json.loads(told.stdout)
    assert answer["results"] == 2 and answer["unwritten"][0]["code"] == "file_unwritable" and answer["unwritten"][0]["where"] == str(out)
    assert str(out) in told.stderr
    assert out.read_text() == before  # no part of a line is left
    new = tmp_path / "new.jsonl"
    started = ran(design, "--out", new, "--samples", 1, "--json", "--quiet", **full(10))
    assert started.returncode == 3 and json.loads(started.stdout)["errors"][0]["code"] == "file_unwritable"
    assert not new.exists()


def test_results_go_to_regular_files_alone(tmp_path):
    """What is there is read first: of a device that would have no end."""
    endless = tmp_path / "zero.jsonl"
    endless.symlink_to("/dev/zero")
    os.mkfifo(tmp_path / "pipe.jsonl")
    for place in (endless, tmp_path / "pipe.jsonl", tmp_path):
        with pytest.raises(fettle.Error, match="regular file"):
            fettle.explore(short_design(), place, samples=1, workers=1)


def test_an_exploration_ends_where_a_file_of_its_design_has_changed(tmp_path):
    """A process that is named, though nothing of what is evaluated follows from it: what changed is not asked."""
    design, out = short_file(tmp_path), tmp_path / "out.jsonl"
    text = json.loads(design.read_text())
    name = text["parameters"][0]["name"]
    text["tolerances"] = {name: {"feature": "length", "process": "mine"}}
    design.write_text(json.dumps(text))
    process = {"fettle_process": 1, "units": "mm", "features": {"length": {"bias": 0, "spread": 0.01}}}
    (tmp_path / "mine.process.json").write_text(json.dumps(process))
    assert len(fettle.explore(design, out, samples=1, workers=1)) == 1
    assert len(fettle.explore(design, out, samples=2, workers=1)) == 2
    process["features"]["length"]["bias"] = -0.3
    (tmp_path / "mine.process.json").write_text(json.dumps(process))
    with pytest.raises(fettle.Error, match="another design"):
        fettle.explore(design, out, samples=2, workers=1)


@needs_program
def test_bytes_that_are_no_text_are_errors_like_others(tmp_path):
    design = short_file(tmp_path)
    text = design.read_bytes()
    broken = tmp_path / os.fsdecode(b"br\xffoken.design.json")
    broken.write_bytes(text.replace(b'"parameters"', b'"para\xffmeters"'))
    named = tmp_path / os.fsdecode(b"na\xffmed.design.json")
    named.write_bytes(text)
    for path, code in ((broken, 3), (tmp_path / os.fsdecode(b"no\xffne.design.json"), 3), (named, 0)):
        out = tmp_path / os.fsdecode(b"o\xffut.jsonl")
        words = (path, "--out", out, "--samples", "1", "--quiet")
        told = ran(*words)
        assert told.returncode in (code, 1)
        assert "internal" not in told.stderr
        assert ran(*words, "--json").returncode in (code, 1)
    with pytest.raises(fettle.Error, match=r"\\xff"):
        fettle.read_design(broken)
