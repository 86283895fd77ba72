# SPDX-License-Identifier: MIT
"""The dataclasses have the library's members and defaults, and what passes through the library comes back as it was."""
import dataclasses
import json
import pathlib
import pickle

import numpy as np
import pytest

import fettle
import fettle_for_tests
from conftest import EXAMPLES, box, tilted_plate


def without_programs(paths):
    """Those whose parts no other program makes (mesh_shape_test.py has them)."""

    def scene(path):
        text = json.loads(path.read_text())
        return json.loads((path.parent / text["scene"]).read_text()) if "fettle_design" in text else text

    return [path for path in sorted(paths) if all("program" not in body.get("shape", {}) for body in scene(path)["bodies"])]


ALL_DESIGNS = without_programs(EXAMPLES.glob("*/*.design.json"))
ROBUST = [path for path in ALL_DESIGNS if "over_tolerances" in path.read_text()]  # no fettle.Design holds them
DESIGNS = [path for path in ALL_DESIGNS if path not in ROBUST]
SCENES = without_programs(EXAMPLES.glob("*/*.scene.json"))
EVERY_QUANTITY = pathlib.Path(__file__).resolve().parents[1] / "quantities" / "every_quantity" / "every_quantity.design.json"


def test_there_are_examples():
    assert DESIGNS and SCENES


@pytest.mark.parametrize("path", DESIGNS, ids=lambda p: p.stem)
def test_a_design_through_python_has_the_same_bits(path):
    """Every member that an example uses is carried both ways: a lost one would change the numbers, or the design."""
    direct = fettle.read_design(str(path)).design
    problem = fettle.DesignProblem(direct)
    again = problem.design
    again.scene.dhat, again.scene.velocity_tolerance = direct.scene.dhat, direct.scene.velocity_tolerance  # the problem fills these in
    for ours, theirs in zip(again.scenarios, direct.scenarios):
        ours.scene.dhat, ours.scene.velocity_tolerance = theirs.scene.dhat, theirs.scene.velocity_tolerance
    assert again == direct
    if direct.scenarios or _has_windows(path):
        return  # a few steps are less than it asks about
    text, answer = fettle_for_tests.evaluate_file(str(path), 3), fettle.DesignProblem(_short(direct, 3))
    at = answer.evaluate(answer.values)
    assert at.reason == text[0]
    assert np.array_equal([at.objective], [text[1]], equal_nan=True)  # not a number: an event that three steps do not reach
    assert np.array_equal(at.gradient, text[2])


def _has_windows(path):
    text = path.read_text()
    return any(f'"{word}":' in text for word in ("from", "to", "at"))


def _short(design, steps):
    return dataclasses.replace(design, steps=steps)


@pytest.mark.parametrize("path", SCENES, ids=lambda p: p.stem)
def test_scenes_pickle_and_come_back(path):
    scene = fettle.read_scene(str(path))
    assert fettle_for_tests.scene_round_trip(scene) == scene
    assert pickle.loads(pickle.dumps(scene)) == scene


def test_defaults_are_the_librarys():
    for name, default in fettle_for_tests.defaults().items():
        assert getattr(fettle, name)() == default, name


def test_every_dataclass_of_a_scene_is_the_librarys():
    known = set(fettle_for_tests.defaults())
    for name in fettle.__all__:
        made = getattr(fettle, name)
        if dataclasses.is_dataclass(made) and made.__module__ in ("fettle.scene", "fettle.results"):
            assert name in known | {"Mesh", "Fault"}, name


def test_a_robust_design_is_refused_rather_than_read_without_its_reserve():
    assert ROBUST
    for path in ROBUST:
        with pytest.raises(fettle.Error, match="optimise_file and `fettle optimise` take the file itself"):
            fettle.read_design(str(path))


def test_designs_pickle():
    design = tilted_plate()
    design.objective, design.constraints, design.shapes = [], [], []
    design.relations = [fettle.Relation("taper", fettle.Bounds(lower=0.6), formula="top / foot")]
    assert pickle.loads(pickle.dumps(design)) == design
    for path in DESIGNS:
        file = fettle.read_design(str(path))
        assert "OpaqueQuantity" not in repr(file.design)
        assert pickle.loads(pickle.dumps(file)) == file


def test_a_files_relation_is_the_same_here(tmp_path):
    """Its plain numbers are millimetres, as in the file, and its variables are the scene's."""
    scene = json.loads((EXAMPLES / "slider_crank" / "slider_crank.scene.json").read_text())
    text = json.loads((EXAMPLES / "slider_crank" / "slider_crank.design.json").read_text())
    text["scene"] = str(EXAMPLES / "slider_crank" / "slider_crank.scene.json")
    assert text["units"] == "mm" and "variables" in scene
    text["constraints"].append({"type": "relation", "name": "arm", "expression": "crank_radius - 10", "lower": "1 mm"})
    path = tmp_path / "relation.design.json"
    path.write_text(json.dumps(text))
    design = fettle.read_design(str(path)).design
    assert design.relations[-1].formula.text == "crank_radius - 10"
    assert pickle.loads(pickle.dumps(design)) == design
    assert fettle_for_tests.design_round_trip(design) == design
    of_file = fettle.DesignProblem.of_file(str(path))
    rows = fettle.DesignProblem(design).relations(of_file.values)
    assert rows.values[-1] == of_file.relations(of_file.values).values[-1] == pytest.approx(3.5e-3)
    design.relations[-1].formula = fettle.Formula("crank_rodius", {"crank_rodius": "m"})
    with pytest.raises(fettle.Error, match="there is no parameter `crank_rodius`; did you mean `crank_radius`"):
        fettle.DesignProblem(design)


LOADS = [
    ({"type": "joint_force", "joint": "rocker pin", "over": "largest"}, fettle.JointLoad("force", "rocker pin", "largest")),
    ({"type": "joint_torque", "joint": "rocker pin", "axis": [1, 0, 0]}, fettle.JointLoad("torque", "rocker pin", axis=np.array([1, 0, 0]))),
    ({"type": "motor_effort", "motor": "drive", "over": "sum"}, fettle.JointLoad("effort", "drive", "sum")),
    ({"type": "energy", "of": "kinetic", "over": "mean"}, fettle.Energy("kinetic", "mean")),
    ({"type": "energy", "of": "kinetic", "over": "rms", "from": "10 ms", "to": 0.03}, fettle.Energy("kinetic", "rms", from_time=0.01, to_time=0.03)),
    ({"type": "motor_effort", "motor": "drive", "at": 0.02}, fettle.JointLoad("effort", "drive", at=0.02)),
    ({"type": "marker_position", "body": "rocker", "point": [1, 2, 3], "origin": [0, 0, 1], "derivative": 2, "over": "peak"},
     fettle.MarkerPosition(3, np.array([0.001, 0.002, 0.003]), "peak", origin=np.array([0, 0, 0.001]), derivative=2)),
    ({"type": "law", "of": "angle", "times": [0, 1], "values": [0, "3 rad"], "profile": "cubic"}, fettle.Law("angle", [0, 1], [0, 3], "cubic")),
    ({"type": "marker_speed", "body": "rocker", "point": [1, 2, 3], "axis": [0, 1, 0]},
     fettle.MarkerSpeed(3, np.array([0.001, 0.002, 0.003]), axis=np.array([0, 1, 0]))),
]


def test_every_quantity_of_a_file_has_a_class():
    """Each kind of the table (quantity_table_test.cpp) arrives as its class, pickles, comes back, and measures the same bits."""
    path = EVERY_QUANTITY
    design = fettle.read_design(str(path)).design
    assert "OpaqueQuantity" not in repr(design)
    assert pickle.loads(pickle.dumps(design)) == design
    assert fettle_for_tests.design_round_trip(design) == design
    free = next(term.quantity for term in design.objective if isinstance(term.quantity, fettle.FreeRange))
    assert free == fettle.FreeRange("hinge", "below", clearance="0.01 mm", anywhere=True)
    reason, objective, gradient = fettle_for_tests.evaluate_file(str(path), 5)
    problem = fettle.DesignProblem(_short(design, 5))
    at = problem.evaluate(problem.values)
    assert at.reason == reason == ""
    assert at.objective == objective
    assert np.array_equal(at.gradient, gradient)


def test_a_free_range_is_refused_where_it_cannot_be_asked_for():
    design = fettle.read_design(str(EVERY_QUANTITY)).design
    for changes, message in (({"end": "up"}, "`up` is neither `above` nor `below`"), ({"clearance": 0.0}, "quantity/clearance: 0 is not allowed"),
                             ({"reach": -1.0}, "quantity/reach: -1 is not allowed"), ({"joint": "hings"}, "did you mean|no joint")):
        design.objective = [fettle.ObjectiveTerm("free", quantity=fettle.FreeRange(**{"joint": "hinge", **changes}))]
        with pytest.raises(fettle.Error, match=message):
            fettle.DesignProblem(design)


def test_forces_of_contact_have_a_class(tmp_path):
    text = json.loads((EXAMPLES / "slider_crank" / "slider_crank.design.json").read_text())
    names = [body["name"] for body in json.loads((EXAMPLES / "slider_crank" / "slider_crank.scene.json").read_text())["bodies"]]
    text["scene"] = str(EXAMPLES / "slider_crank" / "slider_crank.scene.json")
    del text["scenarios"]
    text["objective"] = [{"type": "contact_force", "body": names[1], "over": "mean"},
                         {"type": "contact_force", "body": names[1], "of": names[0], "axis": [0, 0, 1]},
                         {"type": "contact_torque", "body": names[1], "point": [0, 0, 2]}]
    path = tmp_path / "forces.design.json"
    path.write_text(json.dumps(text))
    design = fettle.read_design(str(path)).design
    whole, part, torque = (term.quantity for term in design.objective)
    assert whole == fettle.ContactLoad(1, None, "mean")
    assert part == fettle.ContactLoad(1, 0, axis=np.array([0, 0, 1]))
    assert torque == fettle.ContactLoad(1, about=np.array([0, 0, 0.002]))
    assert pickle.loads(pickle.dumps(design)) == design
    assert fettle_for_tests.design_round_trip(design) == design


def test_loads_and_energies_have_classes(tmp_path):
    """Each kind of a file arrives as its class, pickles, and measures the same bits as when Python was not asked."""
    text = json.loads((EXAMPLES / "path_line" / "path_line.design.json").read_text())
    scene = json.loads((EXAMPLES / "path_line" / "path_line.scene.json").read_text())
    assert scene["motors"][0]["name"] == "drive"
    text["scene"] = str(EXAMPLES / "path_line" / "path_line.scene.json")
    text["objective"] = [{**spoken, "weight": 1 + k} for k, (spoken, _) in enumerate(LOADS)]
    path = tmp_path / "loads.design.json"
    path.write_text(json.dumps(text))
    design = fettle.read_design(str(path)).design
    assert [term.quantity for term in design.objective] == [quantity for _, quantity in LOADS]
    assert pickle.loads(pickle.dumps(design)) == design
    assert fettle_for_tests.design_round_trip(design) == design
    steps = design.steps or 5
    reason, objective, gradient = fettle_for_tests.evaluate_file(str(path), steps)
    problem = fettle.DesignProblem(_short(design, steps))
    at = problem.evaluate(problem.values)
    assert at.reason == reason == ""
    assert at.objective == objective != 0
    assert np.array_equal(at.gradient, gradient) and np.any(gradient != 0)
    assert all(term.value != 0 for term in at.terms[:1] + at.terms[2:])


def test_given_inertia_reaches_the_model():
    moments = np.diag([3e-6, 4e-6, 5e-6])
    body = fettle.Body("cube", mesh=box(0.01, 0.01, 0.01), inertial=fettle.Inertial(0.3, [1e-3, 0, 0], moments))
    scene = fettle.Scene(bodies=[body])
    assert pickle.loads(pickle.dumps(scene)) == scene
    assert np.array_equal(fettle_for_tests.scene_round_trip(scene).bodies[0].inertial.inertia, moments)
    model = fettle.build_model(scene)
    assert model.mass(0) == 0.3
    assert np.array_equal(model.reference_points[0], [1e-3, 0, 0])
    body.inertial.inertia = np.diag([3e-6, 4e-6, 8e-6])
    with pytest.raises(fettle.Error, match="sum of the other two"):
        fettle.build_model(scene)


def test_wrong_members_are_told_by_name():
    body = fettle.Body("cube", mesh=box(0.01, 0.01, 0.01))
    body.density = [1.0]
    with pytest.raises(TypeError, match="Body.density: a value of type list"):
        fettle.build_model(fettle.Scene(bodies=[body]))
    body.density = 1000.0
    body.type = "dynamik"
    with pytest.raises(ValueError, match='"dynamik" is none of: dynamic, static, kinematic'):
        fettle.build_model(fettle.Scene(bodies=[body]))
    body.type = "dynamic"
    body.mesh.triangles = [[0, 1, 99]]
    with pytest.raises(ValueError, match="names a vertex that is not there"):
        fettle.build_model(fettle.Scene(bodies=[body]))


def test_errors_have_code_and_place(tmp_path):
    with pytest.raises(fettle.Error) as missing:
        fettle.read_scene(str(tmp_path / "none.scene.json"))
    assert missing.value.code == "file_not_found"
    path = tmp_path / "bad.scene.json"
    path.write_text('{"fettle_scene": 1, "units": "mm", "bodis": [], "bodies": [{"name": "a", "density": -1}]}')
    with pytest.raises(fettle.Error) as bad:
        fettle.read_scene(str(path))
    found = {(fault.code, fault.where.split("#")[-1]) for fault in bad.value.errors}
    assert ("unknown_key", "/bodis") in found
    assert ("out_of_range", "/bodies/0/density") in found
    assert pickle.loads(pickle.dumps(bad.value)).errors == bad.value.errors
    assert "did you mean" in str(bad.value) or "bodies" in str(bad.value)


def test_notebooks_get_a_table():
    html = fettle.Body("<b>", mesh=box(0.01, 0.01, 0.01))._repr_html_()
    assert "&lt;b&gt;" in html and "<table>" in html
    assert "array of shape" in fettle.Mesh("m", np.zeros((9, 3)))._repr_html_()
    scene = fettle.Scene(bodies=[fettle.Body("a & b", mesh=box(0.01, 0.01, 0.01))], timestep=0.01)
    html = fettle.simulate(fettle.build_model(scene), steps=3).trajectory._repr_html_()
    assert "fettle.Trajectory" in html and "a &amp; b" in html and ">3<" in html and ">0.03<" in html
    assert "<table>" in fettle.Trajectory()._repr_html_()
