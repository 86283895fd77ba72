# SPDX-License-Identifier: MIT
"""Arithmetic with quantities and parameters: objectives and constraints that are expressions, numbers of the scene that are formulas."""
import json
import pickle

import numpy as np
import pytest

import fettle
from conftest import EXAMPLES, MeanHeight, box, tilted_plate
from refusals_test import refused


def evaluated(design):
    problem = fettle.DesignProblem(design)
    evaluation = problem.evaluate(problem.values)
    assert evaluation.usable, evaluation.reason
    return problem, evaluation


def test_quantities_have_arithmetic():
    rise, mass = fettle.Stroke("part", [0, 0, 1]), fettle.Mass([("part", "volume")])
    design = tilted_plate()
    height, own = design.parameters[0], MeanHeight(1)
    free = fettle.Bounds(lower=0)
    design.constraints = [fettle.Constraint(name, free, of) for name, of in (
        ("rise", rise), ("mass", mass), ("own", own),
        ("ratio", rise / height), ("less", 2 * own - height / 3), ("whole", (rise + own) ** 2 / rise), ("negative", -rise), ("sum", "1 mm" + rise),
        ("named", fettle.Expression("max(rise, own / 1000) / height * mass / 1", {"rise": rise, "own": own, "mass": mass})))]
    design.objective = [fettle.ObjectiveTerm("mass of the part", 2, "g", mass + mass)]
    problem, at = evaluated(design)
    (r, m, o), h = [c.value for c in at.constraints[:3]], height.value
    expected = [r / h, 2 * o - h / 3, (r + o) ** 2 / r, -r, 1e-3 + r, r / h * m]
    assert [c.value for c in at.constraints[3:]] == pytest.approx(expected, rel=1e-12)
    assert at.objective == pytest.approx(4 * m / 1e-3)
    dr, dm, do = at.jacobian[:3]
    dh = np.array([1, 0, 0, 0])
    rows = [dr / h - r / h**2 * dh, 2 * do - dh / 3, 2 * (r + o) * (dr + do) / r - (r + o) ** 2 / r**2 * dr, -dr, dr,
            m / h * dr + r / h * dm - r * m / h**2 * dh]
    for found, row in zip(at.jacobian[3:], rows):
        assert found == pytest.approx(row, rel=1e-10, abs=1e-12)
    assert at.gradient == pytest.approx(4e3 * dm)
    passed = problem.design
    assert isinstance(passed.constraints[3].quantity, fettle.Expression)
    assert fettle.DesignProblem(passed).evaluate(problem.values).jacobian == pytest.approx(at.jacobian, rel=1e-14)
    assert len((rise / (rise + rise)).parts) == 1  # it is measured once
    assert pickle.loads(pickle.dumps(rise / height)) == rise / height


def test_faults_of_expressions():
    rise, mass = fettle.Stroke(1, [0, 0, 1]), fettle.Mass([(1, "volume")])
    with pytest.raises(fettle.Error, match="a mass"):
        _ = rise + mass
    refused(lambda: fettle.Expression("a + b", {"a": rise, "b": mass}) * 2, "wrong_type", "formula `a + b`", "a mass")
    design = tilted_plate()
    design.objective = [fettle.ObjectiveTerm("odd", quantity=rise * mass)]
    refused(lambda: fettle.DesignProblem(design), "wrong_type", "objective term `odd`/quantity", "divide")
    design.objective = [fettle.ObjectiveTerm("odd", quantity=fettle.Expression("rise / hight", {"rise": rise}))]
    refused(lambda: fettle.DesignProblem(design), "out_of_range", "formula `rise / hight`", "height")
    design.objective = [fettle.ObjectiveTerm("odd", quantity=rise / fettle.Parameter("other", 1, 0, 2, "mm"))]
    refused(lambda: fettle.DesignProblem(design), "unknown_key", "objective `odd`", "no parameter")
    design.objective = [fettle.ObjectiveTerm("odd", quantity=rise / (rise - rise))]
    problem = fettle.DesignProblem(design)
    assert "its value is not a finite number" in problem.evaluate(problem.values).reason


def test_targets_follow_from_parameters():
    design = tilted_plate()
    height, foot = design.parameters[:2]
    path = fettle.MarkerPath(1, [0, 0, 0], [[foot / 4, 1e-3, height / 2], [2e-3, 0, 4e-3]], [0.02, 0.05])
    design.objective = [fettle.ObjectiveTerm("rise", 1, 1e-6, fettle.Stroke(1, [0, 0, 1], height / 100)), fettle.ObjectiveTerm("path", 1, 1e-6, path)]
    problem, at = evaluated(design)
    assert problem.design.objective[0].quantity.target.inputs == ["height"]
    assert problem.design.objective[1].quantity.targets[0][2].inputs == ["height"]
    assert problem.design.objective[1].quantity.targets[1] == [2e-3, 0, 4e-3]
    assert at.gradient == pytest.approx(2 * at.residual_jacobian.T @ at.residuals, rel=1e-9)
    fixed = tilted_plate()
    fixed.objective = [fettle.ObjectiveTerm("rise", 1, 1e-6, fettle.Stroke(1, [0, 0, 1], 8e-5)),
                       fettle.ObjectiveTerm("path", 1, 1e-6, fettle.MarkerPath(1, [0, 0, 0], [[2e-3, 1e-3, 4e-3], [2e-3, 0, 4e-3]], [0.02, 0.05]))]
    _, plain = evaluated(fixed)
    assert at.objective == pytest.approx(plain.objective, rel=1e-12)
    assert not np.allclose(at.gradient, plain.gradient)


def test_numbers_of_the_scene_may_be_formulas():
    given, written = tilted_plate(), tilted_plate()
    height, foot, _, speed = given.parameters
    part, plate = given.scene.bodies[1], given.scene.bodies[0]
    given.numbers = [number for number in given.numbers if "/dimensions/" in number.place]
    part.position = [foot * fettle.cos("60deg") - "2 mm", "1mm", height / 2 + 1.2e-4]
    plate.prescribed[4].rate = speed
    part.density = 1000 * (height / foot) * "1 kg/m^3"
    given.scene.gravity = [0, 0, -speed * "14 m/s / 1 rad"]
    written.set("/bodies/1/position/0", foot * fettle.cos("60deg") - "2 mm")
    written.set("/bodies/1/density", 1000 * (height / foot) * "1 kg/m^3")
    written.set("/gravity/2", -speed * "14 m/s / 1 rad")
    written.scene.gravity = [0, 0, -9.8]
    assert part.position[1] == 1e-3
    problem, at = evaluated(given)
    other, expected = evaluated(written)
    assert at.objective == expected.objective
    assert at.gradient == pytest.approx(expected.gradient, rel=1e-12) and at.jacobian == pytest.approx(expected.jacobian, rel=1e-12)
    assert {number.place for number in problem.design.numbers} == {number.place for number in other.design.numbers}
    assert isinstance(part.density, fettle.Formula)  # what was given stays as it was
    part.density = foot
    refused(lambda: fettle.DesignProblem(given), "wrong_type", "/bodies/1/density", "a density is expected")


def test_every_number_of_a_mechanism_may_be_a_formula():
    lever, weight = fettle.Body("lever", mesh=box(0.04, 0.008, 0.004)), fettle.Body("weight", mesh=box(0.01, 0.01, 0.01))
    size = fettle.Parameter("size", 1.0, 0.5, 2.0)
    mm = size * "1 mm"
    weight.position = [0, 0.1, 0]
    weight.linear_velocity = [0, 0, size * "1 mm/s"]
    lever.orientation = fettle.Orientation(numbers=[0, size * "0 deg", 0])
    scene = fettle.Scene(bodies=[lever, weight], gravity=[0, 0, "-9.81m/s^2"], timestep=0.002)
    of = scene.mechanism
    of.joints = [fettle.Joint("hinge", b=fettle.Attachment("lever", point=[mm, 0, 0]),
                              forces=fettle.CoordinateForces(stiffness=size * "2 N m/rad", limits=[size * "-30deg", "30deg"], damping=0.01 * size)),
                 fettle.Joint("slide", kind="prismatic", a=fettle.Attachment(point=[0, 0.1, 0]), b=fettle.Attachment("weight"))]
    of.springs = [fettle.Spring("stay", a=fettle.Attachment(point=[0, 0, 0.1 * size * "1 m"]), b=fettle.Attachment("lever", point=["2cm", 0, 0]),
                                forces=fettle.CoordinateForces(stiffness=size * "20 N/m", rest="5cm"))]
    of.motors = [fettle.Motor("push", joint="slide", kind="effort", curve=fettle.Curve(times=[0, 1], values=[size * "1 N", "2 N"]))]
    of.loads = [fettle.PointLoad("pull", body="lever", point=[0, mm, 0], force=[0, 0, size * "1 mN"])]
    scene.friction.materials = {"st/eel": size / 4}
    design = fettle.Design(scene=scene, steps=3, parameters=[size])
    design.objective = [fettle.ObjectiveTerm("energy", quantity=fettle.Energy("total"))]
    problem, at = evaluated(design)
    assert sorted(number.place for number in problem.design.numbers) == sorted([
        "/bodies/0/rotation/1", "/bodies/1/linear_velocity/2", "/joints/0/damping", "/joints/0/limits/0", "/joints/0/point_b/0",
        "/joints/0/stiffness", "/loads/0/force/2", "/loads/0/point/1", "/materials/st~1eel/mu", "/motors/0/force/values/0",
        "/springs/0/point_a/2", "/springs/0/stiffness"])
    step = 1e-4
    ahead, behind = (problem.value([1 + sign * step]) for sign in (1, -1))
    assert at.gradient[0] == pytest.approx((ahead - behind) / (2 * step), rel=1e-5)


def test_expressions_of_a_file(tmp_path):
    document = json.loads((EXAMPLES / "slider_crank" / "slider_crank.design.json").read_text())
    del document["scenarios"]
    document["scene"] = str(EXAMPLES / "slider_crank" / "slider_crank.scene.json")
    document["quantities"] = {"travel": {"type": "stroke", "body": "piston", "axis": [1, 0, 0]}, "weight": {"type": "mass", "bodies": ["piston"]}}
    document["objective"].insert(0, {"type": "expression", "name": "light", "expression": "weight / travel * 1 mm"})
    (tmp_path / "a.design.json").write_text(json.dumps(document))
    term = fettle.read_design(tmp_path / "a.design.json").design.objective[0]
    assert term.name == "light" and sorted(term.quantity.parts) == ["travel", "weight"]
    assert isinstance(term.quantity.parts["travel"], fettle.Stroke) and term.quantity.formula.text == "weight / travel * 1 mm"
