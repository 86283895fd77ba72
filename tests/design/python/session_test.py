# SPDX-License-Identifier: MIT
"""A design that is open: what is set is told, waited for, undone, tuned and saved; nothing that waits is in the way of other threads."""
import inspect
import json
import math
import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import fettle
from fettle import session as module

PATIENCE = 60  # seconds

# A box that falls 0.02 mm onto a table that a motor tilts.
SCENE = {
    "fettle_scene": 1,
    "units": "mm",
    "gravity": [0, 0, -9.81],
    "timestep": 0.005,
    "end_time": 0.1,
    "contact": {"dhat": 0.1},
    "bodies": [
        {
            "name": "table",
            "type": "kinematic",
            "shape": {"part": "box", "dimensions": {"size_x": 60, "size_y": 60, "size_z": 10}},
            "position": [0, 0, -5],
            "prescribed": {"ry": {"rate": 40}},
        },
        {
            "name": "cube",
            "density": 1000,
            "angular_velocity": [20, 10, 0],
            "shape": {"part": "box", "dimensions": {"size_x": 20, "size_y": 12, "size_z": 10}},
            "position": [3, 1, 5.12],
        },
        {
            "name": "wall",
            "type": "static",
            "shape": {"part": "box", "dimensions": {"size_x": 5, "size_y": 60, "size_z": 60}},
            "position": [40, 0, 0],
        },
    ],
}
DESIGN = {
    "fettle_design": 1,
    "scene": "small.scene.json",
    "units": "mm",
    "parameters": [
        {"name": "height", "value": 10, "lower": 6, "upper": 14},
        {"name": "place", "value": 3, "lower": 1, "upper": 60},
        {"name": "speed", "value": 40, "lower": 10, "upper": 60, "unit": "deg/s"},
    ],
    "set": {
        "/bodies/cube/shape/dimensions/size_z": "= height",
        "/bodies/cube/position/0": "= place",
        "/bodies/cube/position/2": "= height / 2 + 0.12",
        "/bodies/table/prescribed/ry/rate": "= speed",
    },
    "objective": [{"type": "mass", "name": "weight", "bodies": ["cube"], "weight": 1}],
    "constraints": [
        {"type": "clearance", "name": "room", "a": "cube", "b": "wall", "minimum": 15, "motion": True},
        {"type": "mass", "name": "mass", "bodies": ["cube"], "lower": "1.5 g", "upper": "4 g"},
        {"type": "relation", "name": "taper", "expression": "height / place", "lower": 0.1},
    ],
    "optimiser": {"name": "mma", "max_evaluations": 8},
}


@pytest.fixture(name="path")
def path_fixture(tmp_path):
    (tmp_path / "small.scene.json").write_text(json.dumps(SCENE))
    (tmp_path / "small.design.json").write_text(json.dumps(DESIGN))
    return tmp_path / "small.design.json"


@pytest.fixture(name="session")
def session_fixture(path):
    with fettle.open(path) as session:
        yield session


def told(session, is_it):
    """The first of the news that is it."""
    return next(news for news in session.news(PATIENCE) if is_it(news))


def test_a_result_is_what_the_designs_own_evaluation_says(path, session):
    assert session.parameter_names == ["height", "place", "speed"]
    assert session.values["height"] == 10e-3 and session.path == str(path) and not session.is_scene
    revision = session.set(height="9mm", speed=0.6)
    result = session.result(PATIENCE)
    assert result.revision == revision == 2
    assert result.values == session.values == pytest.approx({"height": 9e-3, "place": 3e-3, "speed": 0.6})
    problem = fettle.DesignProblem.of_file(path)
    own = problem.evaluate(result.values)
    assert result.objective == own.objective and result.met == (own.violation <= 0)
    assert np.array_equal(result.evaluation.gradient, own.gradient)
    assert np.array_equal(result.evaluation.jacobian, own.jacobian)
    assert result.requirements["mass"].value == own.constraints[1].value == pytest.approx(1e3 * 20e-3 * 12e-3 * 9e-3)
    assert result.requirements["taper"].value == pytest.approx(3)
    (pair,) = result.judged.clearance
    assert pair is result.judged.clearance.pair("cube", "wall") and pair.lower <= result.requirements["room"].upper
    assert result.judged.final is result.evaluation and result.judged.in_doubt == []
    assert repr(result).startswith(result.summary["sentence"][:40]) and "mass" in repr(result)
    assert result.summary["rows"] and "mass" in result._repr_html_()
    assert session.result(0).revision == 2  # it is there
    assert session.set({"height": "9 mm"}) == 2  # what it is already
    assert session.set([8e-3, "3mm", 0.6]) == 3


def test_what_cannot_be_set_is_refused_and_nothing_is_changed(session):
    before = session.values
    for given, code, words in (
        ({"hight": 9e-3}, "unknown_key", "height"),
        ({"height": "15mm"}, "out_of_range", "6 mm to 14 mm"),
        ({"height": math.nan}, "not_finite", "number"),
        ({"height": "9 kg"}, "wrong_type", "mm"),
        ({"height": None}, "wrong_type", "None"),
        ({"place": 1e-3, "height": 1.0}, "out_of_range", "outside its bounds"),
    ):
        with pytest.raises(fettle.Error, match=words) as refused:
            session.set(given)
        assert refused.value.code == code and refused.value.where in given
    with pytest.raises(fettle.Error):
        session.set([1e-3, 2e-3])
    with pytest.raises(TypeError, match="not both"):
        session.set([1e-3, 2e-3, 1], height=1e-3)
    assert session.values == before and session.is_as_in_file
    with pytest.raises(fettle.Error, match="nothing to undo"):
        session.undo()


def test_files_that_cannot_be_opened(tmp_path):
    with pytest.raises(fettle.Error) as missing:
        fettle.open(tmp_path / "none.design.json")
    assert missing.value.code == "file_not_found"
    with pytest.raises(fettle.Error) as wrong:
        fettle.open(3)
    assert wrong.value.code == "wrong_type" and wrong.value.where == "path"


def test_where_there_is_no_design_the_result_says_why(session):
    session.set(place="40mm")  # the cube stands in the wall
    with pytest.raises(fettle.EvaluationError, match="wall"):
        session.result(PATIENCE)
    with pytest.raises(fettle.EvaluationError, match="wall"):
        session.pull("mass", "2.2g", PATIENCE)
    session.undo()
    assert session.result(PATIENCE).evaluation.usable


def test_a_quantity_is_pulled_to_a_value(session):
    pulled = session.pull("mass", "2.2 g", PATIENCE)  # waits for the derivatives
    assert pulled.reaches and pulled.predicted == pytest.approx(2.2e-3)
    assert session.values == pytest.approx(pulled.values) and session.values["height"] < 10e-3
    result = session.result(PATIENCE)
    assert result.revision == pulled.revision
    assert result.requirements["mass"].value == pytest.approx(2.2e-3, rel=1e-4)
    assert not session.pull("taper", 1e3, PATIENCE).reaches
    with pytest.raises(fettle.Error, match='did you mean "mass"') as unknown:
        session.pull("mas", 1)
    assert unknown.value.code == "unknown_key"
    with pytest.raises(fettle.Error) as wrong:
        session.pull("mass", "2mm")
    assert wrong.value.code == "wrong_type"


def test_changes_are_undone(session):
    assert not session.can_undo and not session.can_redo and session.is_as_in_file
    session.set(height=9e-3)
    assert session.can_undo and not session.is_as_in_file
    session.set(place=4e-3)
    assert session.undo() == 4 and session.values["place"] == 3e-3 and session.can_redo
    session.redo()
    assert session.values["place"] == 4e-3
    session.reset()
    assert session.values == {parameter.name: parameter.value for parameter in session.parameters} and session.is_as_in_file


def test_news_come_in_order(session):
    session.set(height=9e-3)
    revision, kinds = 0, []
    for news in session.news(PATIENCE):
        assert news.revision >= revision
        revision = news.revision
        kinds += [news.kind] if news.kind not in ("opened", "progress") and news.revision == 2 else []
        if news.kind == "settled" and news.revision == 2:
            break
    assert kinds == ["asked", "measured", "differentiated", "judged", "settled"]
    # Who comes later is told what still holds, and then waits.
    begin = time.monotonic()
    now = list(session.news(timeout=0.2))
    assert 0.15 < time.monotonic() - begin < 10
    assert [news.kind for news in now if news.kind != "progress"] == ["opened", *kinds]
    assert [parameter.name for parameter in now[0].parameters] == session.parameter_names
    measured, differentiated = (next(news for news in now if news.kind == kind) for kind in ("measured", "differentiated"))
    assert measured.evaluation.gradient.size == 0 and differentiated.evaluation.gradient.size == 3
    assert measured.values["height"] == 9e-3 and measured.summary["rows"]
    assert len(repr(now[-1]).splitlines()) <= 12


def test_the_last_values_win(session):
    for k in range(40):
        session.set(place=(3 + 0.1 * (k + 1)) * 1e-3)
    result = session.result(PATIENCE)
    assert result.values["place"] == pytest.approx(7e-3) and result.revision == 41
    with pytest.raises(TimeoutError, match="within 0 s"):
        session.set(place=5e-3)
        session.result(timeout=0)
    with pytest.raises(fettle.Error) as wrong:
        session.result(timeout=-1)
    assert wrong.value.where == "timeout"


def test_a_search_sets_the_best(session):
    with pytest.raises(fettle.Error, match="no search was begun"):
        session.wait_for_tuning()
    session.tune(max_evaluations=6)
    found = session.wait_for_tuning(PATIENCE)
    assert not found.runs and found.evaluations >= 2 and found.message and not session.is_tuning
    assert session.values == found.values
    result = session.result(PATIENCE)
    assert result.values == found.values and result.objective == pytest.approx(found.objective)
    session.undo()
    session.tune(100_000)
    with pytest.raises(fettle.Error, match="a search runs"):
        session.set(height=9e-3)
    assert session.is_tuning
    session.stop()
    assert session.wait_for_tuning(PATIENCE).message != found.message
    with pytest.raises(fettle.Error) as wrong:
        session.tune(0)
    assert wrong.value.where == "max_evaluations"


def test_nothing_is_asked_of_a_closed_session(path):
    session = fettle.open(path)
    news, raised = session.news(), []

    def wait():
        try:
            while not raised:
                session.set(height=10e-3 if session.values["height"] < 10e-3 else 9e-3)
                session.result()
        except fettle.Error as error:
            raised.append(error)

    waits = threading.Thread(target=wait)
    waits.start()
    time.sleep(0.2)
    session.close()
    waits.join(PATIENCE)
    assert "the session is closed" in str(raised[0]) and session.is_closed
    for call in (session.result, session.undo, lambda: session.set(height=9e-3), lambda: session.values, session.save):
        with pytest.raises(fettle.Error, match="the session is closed"):
            call()
    assert list(news)[0].kind == "opened"  # what was told, and the end
    assert repr(session).endswith("closed)") and "closed" in session._repr_html_()
    session.close()


def test_a_wait_ends_on_ctrl_c_and_lets_others_run(session):
    session.result(PATIENCE)
    ticks, ended = [], threading.Event()

    def tick():
        while not ended.wait(0.01):
            ticks.append(time.monotonic())

    ticking = threading.Thread(target=tick)
    ticking.start()
    timer = threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    begin = time.monotonic()
    try:
        with pytest.raises(KeyboardInterrupt):
            for _ in session.news():
                pass
    finally:
        ended.set()
        ticking.join()
        timer.join()
    assert time.monotonic() - begin < 30 and len(ticks) > 10
    assert session.result(PATIENCE).evaluation.usable  # it goes on


def test_a_design_is_saved_with_its_numbers_alone_changed(path, session, tmp_path):
    session.set(height="9mm")
    other = session.save(tmp_path / "other.design.json")
    assert other == str(tmp_path / "other.design.json")
    saved, drawn = json.loads((tmp_path / "other.design.json").read_text()), json.loads(path.read_text())
    assert saved["parameters"][0]["value"] == 9 and saved["constraints"] == drawn["constraints"]
    assert dict(zip(session.parameter_names, fettle.DesignProblem.of_file(other).values)) == session.values
    with pytest.raises(fettle.Error, match="is there already") as refused:
        session.save(other)
    assert refused.value.code == "file_unwritable"
    session.set(height="8mm")
    session.save(other, replace=True)
    assert json.loads((tmp_path / "other.design.json").read_text())["parameters"][0]["value"] == 8
    with pytest.raises(fettle.Error) as nowhere:
        session.save(path / "in" / "a" / "file.design.json")
    assert nowhere.value.code == "file_unwritable"
    assert session.save() == str(path)
    assert json.loads(path.read_text())["parameters"][0]["value"] == 8
    told(session, lambda news: news.kind == "asked" and news.is_as_in_file)


def test_a_file_that_is_edited_is_read_again(path, session):
    session.set(place="4mm")
    session.result(PATIENCE)
    path.write_text("{ broken")
    faults = told(session, lambda news: news.kind == "faults" and news.errors).errors
    assert isinstance(faults[0], fettle.Fault) and "small.design.json" in faults[0].where
    assert session.values["place"] == 4e-3
    edited = json.loads(json.dumps(DESIGN))
    edited["parameters"][0]["value"] = 8
    path.write_text(json.dumps(edited))
    again = told(session, lambda news: news.kind == "opened" and news.revision > 2)
    assert again.values == {"height": pytest.approx(8e-3), "place": 4e-3, "speed": pytest.approx(math.radians(40))}
    assert session.result(PATIENCE).values["height"] == pytest.approx(8e-3)


def test_a_scene_is_a_design_that_wants_nothing(tmp_path):
    scene = json.loads(json.dumps(SCENE))
    scene["variables"] = {"wide": "20mm"}
    scene["bodies"][1]["shape"]["dimensions"]["size_x"] = "= wide"
    (tmp_path / "wide.scene.json").write_text(json.dumps(scene))
    with fettle.open(tmp_path / "wide.scene.json") as session:
        assert session.is_scene and session.parameter_names == ["wide"]
        session.set(wide="18mm")
        result = session.result(PATIENCE)
        assert len(result.evaluation.simulation.trajectory) == 20 and result.requirements == {}
        with pytest.raises(fettle.Error, match="own file"):
            session.save()
        with pytest.raises(fettle.Error):
            session.tune()


FORGETFUL = """
import sys
import fettle
session = fettle.open(sys.argv[1])
session.tune(100000)
other = fettle.open(sys.argv[1])
del other
print("end")
"""


def test_a_program_ends_with_sessions_open(path):
    done = subprocess.run([sys.executable, "-c", FORGETFUL, path], capture_output=True, text=True, timeout=PATIENCE, check=False)
    assert (done.returncode, done.stdout) == (0, "end\n"), done.stderr
    assert "Traceback" not in done.stderr


class Display:
    """IPython's, of a notebook: what is shown in one place."""

    def __init__(self):
        self.pages = []

    def __call__(self, data, raw, display_id):
        assert raw and display_id and set(data) == {"text/html", "text/plain"}
        self.pages.append(data["text/html"])
        return self

    def update(self, data, raw):
        assert raw
        self.pages.append(data["text/html"])

    def wait(self, words):
        until = time.monotonic() + PATIENCE
        while words not in self.pages[-1]:
            assert time.monotonic() < until, self.pages[-1]
            time.sleep(0.01)


def test_a_notebook_shows_results_as_they_come(path, monkeypatch, capsys):
    display = Display()
    monkeypatch.setattr(module, "_kernel_display", lambda: display)
    with fettle.open(path) as session:
        session._ipython_display_()
        session.set(height="9mm")
        session.result(PATIENCE)
        display.wait(">9<")
        display.wait("done in")
        page = display.pages[-1]
        assert "mass" in page and "opacity:1" in page and "small.design.json" in page
        session.set(place="40mm")
        display.wait("opacity:0.4")
        display.wait("wall")
        session.undo()
        session.tune(2)
        session.wait_for_tuning(PATIENCE)
        display.wait("best objective")
    assert "closed" in display.pages[-1]
    assert not any(thread.name == "fettle session view" for thread in threading.enumerate())
    monkeypatch.undo()
    with fettle.open(path) as session:  # elsewhere it is a line
        session._ipython_display_()
        assert "3 parameters: height, place, speed)" in " ".join(capsys.readouterr().out.split())
        session.result(PATIENCE)
        assert "mass" in session._repr_html_() and "done in" in session._repr_html_()


def test_names_are_escaped(tmp_path):
    design = json.loads(json.dumps(DESIGN))
    design["constraints"][1]["name"] = "<b>mass"
    (tmp_path / "small.scene.json").write_text(json.dumps(SCENE))
    (tmp_path / "small.design.json").write_text(json.dumps(design))
    with fettle.open(tmp_path / "small.design.json") as session:
        assert "<b>" not in session.result(PATIENCE)._repr_html_() + session._repr_html_()


def test_every_public_name_is_exported():
    names = [name for name, made in vars(module).items() if inspect.isclass(made) or inspect.isfunction(made)]
    public = {name for name in names if not name.startswith("_") and getattr(module, name).__module__ == module.__name__}
    assert public and not public - set(fettle.__all__)
