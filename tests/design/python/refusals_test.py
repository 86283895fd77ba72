# SPDX-License-Identifier: MIT
"""What Python hands in and cannot be used: refused with a code, a place and what is allowed; what is no number is no evaluation."""
import math
import os
import pickle

import numpy as np
import pytest

import fettle
from conftest import Frustum, MeanHeight, box, tilted_plate
from simulation_test import falling_cube

NAN, INFINITY = math.nan, math.inf


def refused(call, code, where, words=""):
    with pytest.raises(fettle.Error) as found:
        call()
    assert (found.value.code, found.value.where) == (code, where)
    assert words in str(found.value), found.value


def test_numbers_of_clearances():
    model = falling_cube()
    for name in ("minimum", "tolerance"):
        refused(lambda: fettle.certify_clearance(model, **{name: NAN}), "not_finite", name, "nan")
        refused(lambda: fettle.certify_clearance(model, **{name: INFINITY}), "not_finite", name, "inf")
        refused(lambda: fettle.certify_clearance(model, **{name: -1.0}), "out_of_range", name, "-1 is not allowed")
    refused(lambda: fettle.certify_clearance(model, tolerance=0.0), "out_of_range", "tolerance", "more than 0")
    pairs = [fettle.PairRequest(0, 1), fettle.PairRequest(0, 1, NAN)]
    refused(lambda: fettle.certify_clearance(model, pairs=pairs), "not_finite", "pair request/minimum")
    pairs[1].minimum = -1e-3
    refused(lambda: fettle.certify_clearance(model, pairs=pairs), "out_of_range", "pairs/1/minimum", "0 or more")
    pairs[1].minimum = INFINITY
    refused(lambda: fettle.certify_clearance(model, pairs=pairs), "not_finite", "pairs/1/minimum")
    pairs = [fettle.PairRequest(0, 1, 2e-3, 1e-3)]
    refused(lambda: fettle.certify_clearance(model, pairs=pairs), "out_of_range", "pairs/0/far")
    assert len(fettle.certify_clearance(model, minimum=0.0)) == 1


def test_numbers_of_other_calls(tmp_path):
    model = falling_cube()
    problem = fettle.DesignProblem(tilted_plate())
    for call in (fettle.simulate, fettle.follow_scripts):
        refused(lambda: call(model, steps=-5), "out_of_range", "steps", "end_time")
        refused(lambda: call(model, steps=-1), "out_of_range", "steps", "None")
    assert len(fettle.follow_scripts(model)) == len(fettle.follow_scripts(model, steps=None)) == 10
    scene = fettle.Scene(bodies=[fettle.Body("cube", mesh=box(0.01, 0.01, 0.01))])
    refused(lambda: fettle.build_model(scene, kappa=NAN), "not_finite", "kappa")
    refused(lambda: fettle.build_model(scene, kappa=0.0), "out_of_range", "kappa")
    refused(lambda: fettle.build_model(scene, kappa=True), "wrong_type", "kappa", "a number in N/m")
    scene.max_newton_iterations = 0
    refused(lambda: fettle.build_model(scene), "out_of_range", "scene/max_newton_iterations")
    refused(lambda: fettle.read_mesh("none.stl", unit=0.0), "out_of_range", "unit")
    refused(lambda: fettle.ThreadLimit(0), "out_of_range", "threads")
    refused(lambda: fettle.check_gradients(problem, most_parameters=-1), "out_of_range", "most_parameters")
    refused(lambda: fettle.check_gradients(problem, [1.0]), "inconsistent", "p", "4, found 1")
    refused(lambda: problem.evaluate([1.0, 2.0]), "inconsistent", "p", "4, found 2")
    refused(lambda: fettle.optimise(problem, seed=-1), "out_of_range", "seed")
    refused(lambda: fettle.start_of_seed(problem, -1), "out_of_range", "seed")
    refused(lambda: fettle.optimise_file("none", str(tmp_path), max_evaluations=0), "out_of_range", "max_evaluations")
    refused(lambda: fettle.export_files(str(tmp_path), "vtu", model, every=0), "out_of_range", "every")
    refused(lambda: fettle.export_files(str(tmp_path), "stl", model, in_place=True), "inconsistent", "in_place", "parts")
    refused(lambda: fettle.draw_picture(model, size=(-3, 100)), "out_of_range", "size", "16 to 16384")
    refused(lambda: fettle.to_si(1, "mmm"), "out_of_range", "unit", "mm")


def test_bounds_of_parameters():
    for members, words in (
        ({"lower": -INFINITY}, "its bounds are -inf mm and"),
        ({"value": 1.0}, "its value 1000 mm does not lie within its bounds, "),
    ):
        parameters = tilted_plate().parameters
        for name, value in members.items():
            setattr(parameters[0], name, value)
        refused(changed(parameters=parameters), "out_of_range", "parameter `height`", words)


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full")
def test_a_view_that_cannot_be_written_names_its_file():
    with pytest.raises(OSError, match="/dev/full"):
        fettle.View("page" * 10000).save("/dev/full")


def test_arguments_that_a_function_cannot_take():
    model = falling_cube()
    refused(lambda: fettle.simulate(model, steps=99999999999), "out_of_range", "steps", "-2147483648 to 2147483647")
    refused(lambda: fettle.simulate(model, steps="3"), "wrong_type", "steps", "'3', of type str: a whole number, or None is expected")
    refused(lambda: fettle.simulate(model, stepps=3), "unknown_key", "simulate", "did you mean 'steps'?")
    refused(lambda: fettle.simulate(None), "wrong_type", "model", "None: a fettle.Model is expected")
    refused(lambda: fettle.read_scene(3), "wrong_type", "path", "3, of type int: a path, str or os.PathLike is expected")
    refused(lambda: fettle.read_scene("a", mesh_dirs=[1]), "wrong_type", "mesh_dirs", "a list is expected")
    refused(lambda: fettle.to_si(1), "missing_key", "unit", "is missing: a text is expected")
    refused(lambda: fettle.to_si("0.3mm"), "wrong_type", "number", "'0.3mm', of type str: a number is expected")
    refused(lambda: fettle.ThreadLimit(0), "out_of_range", "threads")
    with pytest.raises(fettle.Error) as found:
        fettle.read_scene(3, strict_meshes="no")
    assert [fault.where for fault in found.value.errors] == ["path", "strict_meshes"] and len(str(found.value)) < 200
    assert pickle.loads(pickle.dumps(fettle.simulate)) is fettle.simulate
    assert fettle.to_si.__doc__ and len(fettle.simulate(model, steps=2).trajectory) == 2


def changed(**members):
    design = tilted_plate()
    for name, value in members.items():
        setattr(design, name, value)
    return lambda: fettle.DesignProblem(design)


def test_numbers_of_designs():
    for bad in (NAN, INFINITY):
        numbers = tilted_plate().numbers
        numbers[1].formula = numbers[1].formula * bad
        refused(changed(numbers=numbers), "not_finite", "/bodies/1/position/2")
    refused(changed(clearance_tolerance=NAN), "not_finite", "design/clearance_tolerance")
    refused(changed(steps=-1), "out_of_range", "steps")
    refused(changed(optimiser=fettle.OptimiserSettings(max_evaluations=0)), "out_of_range", "optimiser/max_evaluations")
    refused(changed(optimiser=fettle.OptimiserSettings(tolerance=-1.0)), "out_of_range", "optimiser/tolerance")
    quantities = {
        "target": fettle.Stroke(1, [0, 0, 1], NAN),
        "targets": fettle.MarkerPath(1, [0, 0, 0], [[0, NAN, 0]]),
        "minimum": fettle.Clearance(0, 1, minimum=NAN),
        "about": fettle.ContactLoad(1, about=[NAN, 0, 0]),
    }
    for member, quantity in quantities.items():
        where = f"objective term `own`/quantity/{member}"
        refused(changed(objective=[fettle.ObjectiveTerm("own", 1, 1e-3, quantity)]), "not_finite", where)
    energy = fettle.ObjectiveTerm("own", 1, 1e-3, fettle.Energy("kinetik"))
    refused(changed(objective=[energy]), "out_of_range", "objective term `own`/quantity/kind", 'did you mean "kinetic"?')


def test_places_in_scenes():
    body = fettle.Body("cube", mesh=box(0.01, 0.01, 0.01))
    scene = fettle.Scene(bodies=[body])
    body.density = NAN
    refused(lambda: fettle.build_model(scene), "not_finite", "body `cube`/density")
    body.density = 1000.0
    body.type = "dynamik"
    refused(lambda: fettle.build_model(scene), "out_of_range", "body `cube`/type", 'did you mean "dynamic"?')
    body.type = "dynamic"
    body.prescribed[2] = fettle.MotionCurve(rate=NAN)
    refused(lambda: fettle.build_model(scene), "not_finite", "body `cube`/prescribed/rate")
    body.prescribed[2] = None
    scene.integrator = "euler"
    refused(lambda: fettle.build_model(scene), "out_of_range", "scene/integrator", "implicit_euler")
    scene.integrator = "bdf2"
    body.mesh.triangles = [[0, 1, 2], [0, 1, 99]]
    refused(lambda: fettle.build_model(scene), "mesh_invalid", "mesh `box`/triangles/1", "99; the mesh has 8")
    body.mesh.vertices = np.zeros((8, 2))
    refused(lambda: fettle.build_model(scene), "wrong_type", "mesh `box`/vertices", "(n, 3)")
    design = tilted_plate()
    design.parameters[0].unit = "mn"
    refused(lambda: fettle.DesignProblem(design), "out_of_range", "parameter `height`/unit", '"mn" is not a unit')


def test_what_is_of_no_class_that_is_wanted():
    def scene(**members):
        return lambda: fettle.build_model(fettle.Scene(**{"bodies": [fettle.Body("cube", mesh=box(0.01, 0.01, 0.01))], **members}))

    refused(scene(bodies=["a"]), "wrong_type", "scene/bodies/0", "'a', of type str: a fettle.Body is expected")
    refused(scene(bodies=None), "wrong_type", "scene/bodies", "a list of fettle.Body is expected")
    refused(scene(mechanism=fettle.Mechanism(joints=["pin"])), "wrong_type", "mechanism/joints/0", "a fettle.Joint is expected")
    refused(scene(mechanism=None), "wrong_type", "scene/mechanism", "a fettle.Mechanism is expected")
    joint = fettle.Joint("pin", b=fettle.Attachment("cube"), forces=3)
    refused(scene(mechanism=fettle.Mechanism(joints=[joint])), "wrong_type", "joint `pin`/forces", "a fettle.CoordinateForces is expected")
    joint = fettle.Joint("pin", b=fettle.Attachment("cub"))
    refused(scene(mechanism=fettle.Mechanism(joints=[joint])), "inconsistent", "joint `pin`", "no body is called `cub`")
    for members, words in (
        ({"gravity": [0, -9.81]}, "Scene.gravity: .* three numbers are expected"),
        ({"timestep": True}, "Scene.timestep: a value of type bool .* a number is expected"),
        ({"end_time": True}, "Scene.end_time: .* a number, or None, is expected"),
        ({"max_newton_iterations": True}, "a whole number is expected"),
    ):
        with pytest.raises(TypeError, match=words):
            scene(**members)()


def test_misspelt_members():
    body = fettle.Body("cube")
    with pytest.raises(AttributeError, match="Body has no member 'densty'; did you mean 'density'"):
        body.densty = 5
    with pytest.raises(AttributeError, match="there are place, formula"):
        fettle.BoundNumber().xyz = 1
    for made in (fettle.Part("box"), fettle.FunctionShape(None, {}), fettle.Design(), fettle.PairRequest()):
        with pytest.raises(AttributeError, match="no member"):
            made.mine = 1
    with pytest.raises(AttributeError, match="Scene has no member 'gravitty'; did you mean 'gravity'"):
        fettle.Scene().gravitty = [0, 0, -9.81]
    with pytest.raises(AttributeError, match="Scene has no member 'timestepp'; did you mean 'timestep'"):
        _ = fettle.Scene().timestepp
    with pytest.raises(TypeError, match="gravitty"):
        fettle.Scene(gravitty=[0, 0, -9.81])
    for made in (falling_cube(), fettle.DesignProblem(tilted_plate()), fettle.Trajectory()):
        with pytest.raises(AttributeError):
            made.mine = 1
    own = MeanHeight(1)  # what derives from the two interfaces has what members it likes
    own.mine = 1
    Frustum(1, 1, 1).mine = 1


def test_two_of_one_name():
    """Pairs, joints, files find things by their names."""
    twins = [fettle.Body("cube", mesh=box(0.01, 0.01, 0.01)), fettle.Body("cube", mesh=box(0.01, 0.01, 0.01))]
    twins[1].pose.position = ["1m", 0, 0]
    scene = fettle.Scene(bodies=twins)
    refused(lambda: fettle.build_model(scene), "inconsistent", "body `cube`", "another body is called `cube` already")
    refused(lambda: fettle.DesignProblem(fettle.Design(scene=scene)), "inconsistent", "body `cube`", "names are unique")
    twins[1].name = ""
    refused(lambda: fettle.build_model(scene), "out_of_range", "scene/bodies/1/name", "a body needs a name")
    twins[0].name, twins[1].name = "a", "b"
    joint = fettle.Joint("pin", b=fettle.Attachment("a"))
    scene.mechanism = fettle.Mechanism(joints=[joint])
    assert fettle.build_model(scene)
    for member, made in (("joints", joint), ("motors", fettle.Motor("m", joint="pin")), ("loads", fettle.PointLoad("l", body="a")),
                         ("springs", fettle.Spring("s", joint="pin", forces=fettle.CoordinateForces(stiffness=1.0, rest=0.0)))):
        scene.mechanism = fettle.Mechanism(joints=[joint])
        setattr(scene.mechanism, member, [made])
        if member != "motors":
            assert fettle.build_model(scene), member
        setattr(scene.mechanism, member, [made, made])
        with pytest.raises(fettle.Error, match="is called `.*` already"):
            fettle.build_model(scene)


def test_parts_and_dimensions():
    refused(fettle.Part("bix").dimensions, "unknown_key", "bix", "box")
    refused(lambda: fettle.shape_at(fettle.Part("box", {"size_x": NAN})), "not_finite", "part/values")
    refused(lambda: fettle.shape_at(fettle.Part("box"), {"size_q": 1e-3}), "unknown_key", "size_q", "size_x")
    refused(lambda: fettle.shape_at(fettle.Part("box"), {"size_x": NAN}), "not_finite", "size_x")


def test_an_evaluation_error_has_errors():
    design = tilted_plate()
    design.parameters[1].lower = -1e-3
    problem = fettle.DesignProblem(design)
    p = problem.values
    p[1] = -1e-3
    with pytest.raises(fettle.EvaluationError) as failed:
        problem.value(p)
    (fault,) = failed.value.errors
    assert (failed.value.code, failed.value.where) == (fault.code, fault.where) == ("inconsistent", "design")
    assert fault.message == str(failed.value) and "above 0" in fault.message
    assert pickle.loads(pickle.dumps(failed.value)).errors == failed.value.errors


class Answering(MeanHeight):
    """A height that answers something else."""

    def __init__(self, answer=None, **gradient):
        super().__init__(1)
        self.answer, self.changed = answer, gradient

    def value(self, simulated):
        return super().value(simulated) if self.changed else self.answer

    def gradient(self, simulated):
        right = super().gradient(simulated)
        for name, change in self.changed.items():
            setattr(right, name, change(getattr(right, name)))
        return right


def constrained(quantity):
    design = tilted_plate()
    design.constraints = [fettle.Constraint("own", fettle.Bounds(lower=-1.0), quantity)]
    return fettle.DesignProblem(design)


def test_a_value_that_is_no_number_is_no_evaluation():
    for answer in (NAN, INFINITY, np.float64(NAN), fettle.Measurement(NAN, NAN, NAN), fettle.Measurement(INFINITY, 0, INFINITY)):
        problem = constrained(Answering(answer))
        at = problem.evaluate(problem.values)
        assert not at.usable and math.isnan(at.objective) and math.isnan(at.violation)
        assert "constraint `own`" in at.reason and "finite" in at.reason
        with pytest.raises(fettle.EvaluationError, match="constraint `own`"):
            problem.value(problem.values)


def test_a_gradient_that_is_no_number_is_no_evaluation():
    changes = {
        "positions": lambda _: np.full((13, 2, 3), NAN),
        "rotations": lambda _: np.full((13, 2, 3, 3), NAN),
        "vertices": lambda found: {1: NAN * found[1]},
        "densities": lambda _: {1: NAN},
    }
    for name, change in changes.items():
        problem = constrained(Answering(**{name: change}))
        at = problem.evaluate(problem.values)
        assert not at.usable and math.isnan(at.objective) and math.isnan(at.violation), name
        assert "constraint `own`" in at.reason and "finite" in at.reason, (name, at.reason)


def test_answers_of_other_types_are_told():
    for answer, told in ((None, "None"), ("a", "'a', of type str"), ([1.0, 2.0], "of type list"), (fettle.Measurement("a"), "'a'")):
        problem = constrained(Answering(answer))
        with pytest.raises(fettle.Error, match="a number( or a fettle.Measurement)? is expected") as found:
            problem.value(problem.values)
        assert found.value.code == "wrong_type" and found.value.where.startswith("Answering.value()")
        assert told in str(found.value)
    faults = {
        "positions": (lambda _: np.zeros(3), "wrong_type", "Answering.gradient()/positions"),
        "vertices": (lambda _: {7: np.zeros((8, 3))}, "out_of_range", "Answering.gradient()/vertices"),
        "densities": (lambda _: {1: "a"}, "wrong_type", "Answering.gradient()/densities/1"),
    }
    for name, (change, code, where) in faults.items():
        problem = constrained(Answering(**{name: change}))
        refused(lambda: problem.value_and_gradient(problem.values), code, where)


class OddFrustum(Frustum):
    """A frustum whose at() answers something else."""

    def __init__(self, answer):
        super().__init__(8e-3, 5e-3, 8e-3)
        self.answer = answer

    def at(self, values):
        return self.answer(*super().at(values))


def test_what_shapes_answer():
    broken = np.zeros((8, 3))
    broken[3, 1] = NAN
    cases = [
        (lambda mesh, by: None, "wrong_type", "returned None; (fettle.Mesh, {dimension: derivatives}) is expected"),
        (lambda mesh, by: (None, by), "wrong_type", "returned None; a fettle.Mesh is expected"),
        (lambda mesh, by: (mesh, None), "wrong_type", "is expected"),
        (lambda mesh, by: (mesh, {**by, "top": broken}), "not_finite", "the derivative by `top`"),
        (lambda mesh, by: (mesh, {"foot": by["foot"]}), "missing_key", "the derivative by `top` is missing"),
        (lambda mesh, by: (mesh, {**by, "top": broken[1:]}), "inconsistent", "a row per vertex of the mesh: 8"),
    ]
    for answer, code, words in cases:
        refused(lambda: fettle.shape_at(OddFrustum(answer)), code, "OddFrustum.at()", words)
    # In an evaluation: one that failed, and says of what.
    design = tilted_plate(shape=OddFrustum(lambda mesh, by: (mesh, by if mesh.vertices[:, 2].max() < 4.1e-3 else {**by, "top": broken})))
    problem = fettle.DesignProblem(design)
    at = problem.evaluate(problem.values + [1e-3, 0, 0, 0])
    assert not at.usable and "the derivative by `top`" in at.reason
    drawn = {"radius": 1e-3}
    refused(lambda: fettle.shape_at(fettle.MeshShape(lambda values: None, drawn)), "wrong_type", "MeshShape.function()", "returned None")
    refused(lambda: fettle.shape_at(fettle.MeshShape(lambda values: None, drawn, unit=0.0)), "out_of_range", "mesh shape/unit")
    refused(lambda: fettle.shape_at(fettle.MeshShape(lambda values: None, {"radius": NAN})), "not_finite", "mesh shape/values")
    refused(lambda: fettle.shape_at(fettle.FunctionShape(lambda values: None, {"radius": None})), "wrong_type", "FunctionShape.dimensions()")
    refused(lambda: fettle.FunctionShape(lambda values: None, {"radius": "a"}), "parse", "function shape/values/radius")


def test_a_quantity_from_functions():
    expected = fettle.DesignProblem(tilted_plate())
    own = MeanHeight(1)
    problem = fettle.DesignProblem(tilted_plate(fettle.FunctionQuantity(own.value, own.gradient, "length")))
    assert problem.design.constraints[0].quantity.dimension == "length"
    for found, wanted in zip(problem.value_and_gradient(problem.values), expected.value_and_gradient(expected.values)):
        assert np.array_equal(found, wanted)
