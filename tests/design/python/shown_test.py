# SPDX-License-Identifier: MIT
"""How things show themselves: in few lines of text, and in notebooks, with what they hold."""
import base64
import html
import re
import shutil
import sys
import time

import pytest

import fettle
from conftest import ROOT, MeanHeight, box, tilted_plate
from simulation_test import falling_cube

sys.path.insert(0, str(ROOT / "tests" / "design" / "report"))
from chromium import Chromium  # noqa: E402

MOST_LINES, MOST_LETTERS = 12, 1300


def shown(value):
    text = repr(value)
    assert len(text.splitlines()) <= MOST_LINES and len(text) <= MOST_LETTERS, text
    return text


@pytest.fixture(name="fall", scope="module")
def fall_fixture():
    model = falling_cube()
    return model, fettle.simulate(model, outputs=True)


def test_a_repr_is_of_some_lines(fall):
    model, simulation = fall
    problem = fettle.DesignProblem(tilted_plate())
    at = problem.evaluate(problem.values)
    outcome = fettle.optimise(problem)
    wheel = fettle.Part("eccentric").at({})[0]
    scene = fettle.Scene(bodies=[fettle.Body(f"body number {k} of the scene", mesh=wheel) for k in range(100)])
    for value in (
        simulation, simulation.report, simulation.outputs, simulation.outputs[0], simulation.report.steps, at, outcome, outcome.report,
        fettle.check_gradients(problem), fettle.check_gradients(problem).rows, scene, scene.bodies[0], wheel, problem.design, problem,
        model, simulation.trajectory, fettle.certify_clearance(model, simulation.trajectory), scene.mechanism,
    ):
        shown(value)
    assert "'height'" in shown(problem.design.parameters[0]) and "0.008" in shown(problem.design.parameters[0])
    assert shown(model) == "Model(2 bodies: table, cube)"
    assert shown(simulation.trajectory) == "Trajectory(2 bodies: table, cube; 10 steps of 0.01 s)"
    assert shown(fettle.as_assembled(model)) == "Trajectory(2 bodies: table, cube; as assembled)"
    assert shown(problem) == "DesignProblem(4 parameters: height, foot, top, speed)"
    assert "10 StepOutputs" in shown(simulation.outputs)


def test_pairs_show_names_verdicts_and_bounds(fall):
    model, simulation = fall
    pairs = fettle.certify_clearance(model, simulation.trajectory, minimum="20um")
    pair = pairs.pair("cube", "table")
    assert pair is pairs[0] is pairs.pair("table", "cube")
    text = shown(pairs)
    assert text.startswith(f"table:cube  {pair.status}  ")
    told = re.search(r"(\S+) \.\. (\S+) m", text).groups()
    low, high = map(float, told)
    assert low <= pair.lower and pair.upper <= high  # rounded away from what is proven, not towards it
    assert pair.lower - low < 1e-9 and high - pair.upper < 1e-9
    table = pairs._repr_html_()
    assert "table:cube" in table and pair.status in table and all(f">{bound}<" in table for bound in told)
    with pytest.raises(KeyError, match="did you mean 'cube'"):
        pairs.pair("cub", "table")
    with pytest.raises(KeyError, match="not asked for"):
        pairs.pair("cube", "cube")
    assert list(pairs) == pairs and pairs[:1] == [pair]
    many = fettle.Pairs(list(pairs) * 1000, model.body_names)
    assert "and 991 more pairs" in shown(many) and "and 980 more" in many._repr_html_()


def test_notebooks_get_members_and_their_values(fall):
    model, simulation = fall
    told = simulation._repr_html_()
    assert "10 steps of 0.01 s" in told and "&#x27;ok&#x27;" in told and "object at" not in told
    told = simulation.outputs._repr_html_()
    assert told.count("<tr>") == 11 and "kinetic_energy" in told and repr(simulation.outputs[3].time) in told
    told = model._repr_html_()
    assert "cube" in told and "dynamic" in told and "data:image/png;base64," in told
    problem = fettle.DesignProblem(tilted_plate())
    told = problem._repr_html_()
    assert "height" in told and "0.012" in told
    told = problem.evaluate(problem.values)._repr_html_()
    assert "objective" in told and "object at" not in told
    scene = fettle.Scene(bodies=[fettle.Body("<script>", mesh=box(0.01, 0.01, 0.01))])
    assert "<script>" not in scene._repr_html_() + fettle.build_model(scene)._repr_html_() + scene.bodies[0]._repr_html_()


def test_a_check_and_an_optimisation_show_their_numbers():
    problem = fettle.DesignProblem(tilted_plate())
    told = fettle.check_gradients(problem)._repr_html_()
    assert "largest relative error" in told and "height" in told and "adjoint" in told and "CheckRow" not in told
    outcome = fettle.optimise(problem)
    told = outcome._repr_html_()
    assert outcome.report.status in told and f"{outcome.report.point[0]:.6g}" in told and "Report(" not in told
    rows = [fettle.CheckReport(rows=[fettle.CheckRow(f"q{k}", "<p>", relative_error=e) for k, e in enumerate((1e-9, float("nan"), 1e-3))])]
    told = rows[0]._repr_html_()
    assert told.index("q1") < told.index("q2") < told.index("q0") and "&lt;p&gt;" in told


def test_an_exploration_shows_its_best(tmp_path):
    design = tilted_plate(MeanHeight(1))
    design.steps = 1
    found = fettle.explore(design, tmp_path / "a.jsonl", sweep={"height": 2}, workers=1)
    told = found._repr_html_()
    assert "height" in told and str(found.best()[0]["parameters"]["height"]) in told


def framed(view):
    """The page inside a view's frame, as a browser unpacks it."""
    (page,) = re.findall(r'srcdoc="([^"]*)"', view._repr_html_())
    return html.unescape(page)


def test_a_view_is_a_page_of_its_own_in_a_frame(fall):
    model, simulation = fall
    view = fettle.view(model, simulation.trajectory, title="a </script> & fall", height=500)
    assert framed(view) == view.page
    told = view._repr_html_()
    assert told.startswith("<iframe sandbox=\"allow-scripts\"") and "height:500px" in told and told.count("<iframe") == 1
    assert "a </script>" not in view.page  # data, whatever it is called
    assert not re.findall(r"(?:src|href)=[\"']?(?:https?:)?//", view.page)  # nothing is fetched
    assert "a notebook shows it" in shown(view)
    with pytest.raises(fettle.Error, match="not of this model"):
        fettle.view(fettle.DesignProblem(tilted_plate()).model_at({}), fettle.Trajectory())


def test_a_view_claims_nothing(fall):
    """What is shown was not judged: the page must not say that it was."""
    model, simulation = fall
    for view in (fettle.view(model), fettle.view(model, simulation.trajectory)):
        assert '"kind":"clearance"' in view.page and '"status":"shown"' in view.page
        assert "certify_clearance proves distances" in view.page


def test_a_browser_shows_the_frame(fall, tmp_path):
    program = shutil.which("chromium")
    if program is None:
        pytest.skip("there is no chromium")
    model, simulation = fall
    notebook = tmp_path / "notebook.html"
    notebook.write_text(f"<!doctype html><meta charset=utf-8><body>{fettle.view(model, simulation.trajectory)._repr_html_()}</body>")
    browser = Chromium(program)
    try:
        page = browser.open(notebook.as_uri())  # without a network
        page.wait("document.readyState === 'complete' && document.querySelector('iframe')")
        until, shown_bytes = time.monotonic() + 60, 0
        while shown_bytes < 20_000 and time.monotonic() < until:  # an empty frame has some 5 kB
            shown_bytes = len(base64.b64decode(page.send("Page.captureScreenshot")["data"]))
            time.sleep(0.2)
        assert shown_bytes >= 20_000 and page.complaints == []
    finally:
        browser.close()
