# SPDX-License-Identifier: MIT
"""Numbers with units, bodies by name and paths of any kind, wherever a number, a body or a path is taken."""
import pathlib
import pickle

import numpy as np
import pytest

import fettle
import fettle_for_tests
from conftest import EXAMPLES, Frustum, MeanHeight, box, tilted_plate
from refusals_test import refused
from simulation_test import falling_cube

DESIGN = EXAMPLES / "slider_crank" / "slider_crank.design.json"


def test_members_with_a_dimension_take_units():
    given = {
        fettle.Scene: {
            "timestep": ("5ms", 5e-3), "end_time": ("2 s", 2), "dhat": ("50um", 50e-6), "dmin": ("0.1mm", 1e-4), "kappa": ("3 N/mm", 3e3),
            "velocity_tolerance": ("1 mm/s", 1e-3), "length_unit": ("in", 0.0254), "gravity": ([0, 0, "-9.81m/s^2"], [0, 0, -9.81]),
            "contact_damping_time": ("1ms", 1e-3),
        },
        fettle.Body: {
            "density": ("1.24 g/cm^3", 1240), "linear_velocity": (("1mm/s", 0, "1 cm/s"), (1e-3, 0, 1e-2)), "force": (["1mN", 0, 0], [1e-3, 0, 0]),
            "angular_velocity": (["60rpm", 0, 0], [60 * np.pi / 30, 0, 0]), "torque": (["1Nmm", 0, 0], [1e-3, 0, 0]),
            "reference_point": (["1in", 0, 0], [0.0254, 0, 0]),
        },
        fettle.Pose: {"position": (["1mm", "2 mm", 0], [1e-3, 2e-3, 0])},
        fettle.Attachment: {"point": (["1mm", 0, 0], [1e-3, 0, 0])},
        fettle.PointLoad: {"point": (["1mm", 0, 0], [1e-3, 0, 0]), "force": (["1kN", 0, 0], [1e3, 0, 0])},
        fettle.Inertial: {"mass": ("12g", 0.012), "centre": (["1mm", 0, 0], [1e-3, 0, 0])},
        fettle.Friction: {"eps_v": ("2mm/s", 2e-3)},
        fettle.MotionCurve: {"rate": ("90 deg/s", np.pi / 2), "times": (["1ms"], [1e-3]), "values": (["90deg"], [np.pi / 2])},
        fettle.Curve: {"rate": ("90 deg/s", np.pi / 2), "times": (["1ms"], [1e-3]), "values": (["3mm"], [3e-3])},
        fettle.CoordinateForces: {"limits": (("-30deg", "30deg"), (-np.pi / 6, np.pi / 6)), "stiffness": ("1N/mm", 1e3), "rest": ("1mm", 1e-3)},
        fettle.Joint: {"pitch": ("2mm", 2e-3), "swing": ("30deg", np.pi / 6), "ratio": ("5mm", 5e-3)},
        fettle.MeshProgram: {"unit": ("mm", 1e-3), "time_limit": ("1min", 60)},
        fettle.ShapeSpec: {"dimensions": ({"radius": "3mm"}, {"radius": 3e-3})},
        fettle.PairRequest: {"minimum": ("0.3mm", 3e-4), "far": ("1cm", 1e-2)},
        fettle.Bounds: {"lower": ("0.3mm", 3e-4), "upper": ("1mm", 1e-3), "margin": ("10um", 1e-5), "unit": ("mm", 1e-3)},
        fettle.ObjectiveTerm: {"unit": ("g", 1e-3)},
        fettle.Design: {"clearance_tolerance": ("1um", 1e-6)},
    }
    for kind, members in given.items():
        made = kind(**{name: text for name, (text, _) in members.items()})
        for name, (text, si) in members.items():
            assert getattr(made, name) == pytest.approx(si, rel=1e-15), (kind, name)
            setattr(made, name, text)
            assert getattr(made, name) == pytest.approx(si, rel=1e-15), (kind, name)
        assert pickle.loads(pickle.dumps(made)) == made
    part = fettle.Part("box", {"size_x": "3mm"})
    assert part.values == {"size_x": 3e-3}
    assert fettle.MarkerPath("a", ["1mm", 0, 0], [["1mm", 0, 0], [0, "2mm", 0]]).targets == [[1e-3, 0, 0], [0, 2e-3, 0]]
    assert fettle.Stroke(1, [0, 0, 1], "30mm").target == 0.03
    assert fettle.parse_quantity("0.3mm") == 3e-4 and fettle.units()["rpm"] == "angular_speed"


def test_a_wrong_unit_is_told_where_it_is_given():
    refused(lambda: fettle.Scene(timestep="5mm"), "wrong_type", "scene/timestep", "a time is expected")
    refused(lambda: fettle.Scene(timestep="5"), "out_of_range", "scene/timestep", "without a unit")
    refused(lambda: fettle.Scene(timestep="soon"), "parse", "scene/timestep")
    body = fettle.Body("cube")
    refused(lambda: setattr(body, "density", "3 kg"), "wrong_type", "body `cube`/density", "a unit of mass, a density is expected")
    refused(lambda: fettle.Part("box", {"size_x": "3kg"}), "wrong_type", "part/values/size_x")
    refused(lambda: fettle.Parameter("height", "8kg", 0, 1, "mm"), "wrong_type", "parameter `height`/value")
    refused(lambda: fettle.Parameter("height", "8mm", 0, 1), "wrong_type", "parameter `height`/value")


def jointed(**forces):
    """A lever on a hinge."""
    lever = fettle.Body("lever", mesh=box(0.04, 0.008, 0.004))
    scene = fettle.Scene(bodies=[lever], gravity=[0, 0, -9.81])
    scene.mechanism.joints.append(fettle.Joint("hinge", b=fettle.Attachment("lever"), forces=fettle.CoordinateForces(**forces)))
    return scene


def test_units_of_coordinates_are_those_of_their_joint():
    assert fettle.build_model(jointed(limits=["-30deg", "30deg"], friction="2 N mm"))
    refused(lambda: fettle.build_model(jointed(limits=["-3mm", "3mm"])), "wrong_type", "joint `hinge`/forces/limits", "angle is expected")
    refused(lambda: fettle.build_model(jointed(friction="2 N")), "wrong_type", "joint `hinge`/forces/friction", "torque is expected")
    refused(lambda: fettle.build_model(jointed(stiffness="2 N/m")), "wrong_type", "joint `hinge`/forces/stiffness", "angular stiffness is expected")
    scene = jointed()
    scene.mechanism.motors.append(fettle.Motor("drive", joint="hinge", curve=fettle.Curve(rate="60rpm")))
    assert fettle.build_model(scene)
    scene.mechanism.motors[0].curve.rate = "60mm/s"
    refused(lambda: fettle.build_model(scene), "wrong_type", "motor `drive`/curve/rate", "angular speed is expected")
    scene.mechanism.motors.clear()
    scene.bodies.append(fettle.Body("slide", "", "kinematic", box(0.01, 0.01, 0.01), prescribed=fettle.held()))
    scene.bodies[1].pose.position = ["10cm", 0, 0]
    scene.bodies[1].prescribed[0].rate = "3deg/s"
    refused(lambda: fettle.build_model(scene), "wrong_type", "body `slide`/prescribed/0/rate", "speed is expected")


def test_units_of_requirements_are_those_of_what_they_bound():
    design = tilted_plate()
    design.parameters[0] = fettle.Parameter("height", "8mm", "6mm", "12mm", "mm")
    design.constraints[0].bounds = fettle.Bounds(lower="3.9mm", unit="mm")
    design.objective[1].unit = "g"
    plain = fettle.DesignProblem(tilted_plate())
    expected = plain.evaluate(plain.values)
    problem = fettle.DesignProblem(design)
    assert problem.evaluate(problem.values).objective == expected.objective
    design.constraints[0].bounds.lower = "3.9g"
    refused(lambda: fettle.DesignProblem(design), "wrong_type", "constraint `height`/bounds/lower", "length is expected")
    design.constraints[0].bounds.lower = 3.9e-3
    design.objective[1].unit = "mm"
    refused(lambda: fettle.DesignProblem(design), "wrong_type", "objective term `mass`/unit", "mass is expected")


def test_calls_take_units_and_names():
    model = falling_cube()
    trajectory = fettle.simulate(model).trajectory
    (si,) = fettle.certify_clearance(model, trajectory, minimum=2e-5, tolerance=1e-6)
    assert fettle.certify_clearance(model, trajectory, minimum="20um", tolerance="1um") == [si]
    for pair in (("table", "cube"), ("table", 1), (0, "cube", "20um"), fettle.PairRequest("table", "cube", "20um")):
        (found,) = fettle.certify_clearance(model, trajectory, [pair], minimum=2e-5)
        assert found == si
    refused(lambda: fettle.certify_clearance(model, pairs=[("tabel", "cube")]), "out_of_range", "pairs/0/a", "did you mean \"table\"?")
    refused(lambda: fettle.certify_clearance(model, pairs=["table"]), "wrong_type", "pairs/0", "(a, b)")
    refused(lambda: fettle.certify_clearance(model, pairs="table:cube"), "wrong_type", "pairs", "a list of pairs")
    refused(lambda: fettle.certify_clearance(model, minimum="3kg"), "wrong_type", "minimum")
    refused(lambda: fettle.certify_clearance(model, minimum=None), "wrong_type", "minimum", "None")
    assert model.mass("cube") == model.mass(1) and model.may_collide("cube", "table")
    assert np.array_equal(model.vertices("cube"), model.vertices(1))
    scene = fettle.Scene(bodies=[fettle.Body("cube", mesh=box(0.01, 0.01, 0.01))])
    assert fettle.build_model(scene, kappa="2N/mm").kappa == 2000
    assert fettle.shape_at(fettle.Part("box"), {"size_x": "3mm"})[0] == fettle.shape_at(fettle.Part("box"), {"size_x": 3e-3})[0]


def test_designs_name_bodies():
    part = Frustum(8e-3, 5e-3, 8e-3)
    numbered, named = tilted_plate(shape=part), tilted_plate(shape=part)
    numbered.constraints = [fettle.Constraint("gap", fettle.Bounds(lower=0, unit=1e-3), fettle.Clearance(0, 1, motion=True))]
    named.constraints = [fettle.Constraint("gap", fettle.Bounds(lower=0, unit=1e-3), fettle.Clearance("plate", "part", motion=True))]
    numbered.objective = [fettle.ObjectiveTerm("mass", 1, 1e-3, fettle.Mass([(1, "volume")]))]
    named.objective = [fettle.ObjectiveTerm("mass", 1, 1e-3, fettle.Mass([("part", "volume")]))]
    for number in named.numbers:
        number.place = number.place.replace("/0/", "/plate/", 1).replace("/1/", "/part/", 1)
    found = fettle.DesignProblem(named)
    assert found.design == fettle.DesignProblem(numbered).design
    assert named.constraints[0].quantity.a == "plate"  # what was given stays as it was
    named.constraints[0].quantity.b = "prat"
    refused(lambda: fettle.DesignProblem(named), "out_of_range", "Clearance/b", "did you mean 'part'?")


def test_points_by_name_and_with_units():
    problem = fettle.DesignProblem(tilted_plate())
    p = problem.values
    p[0], p[3] = 9e-3, 0.5
    expected = problem.value(p)
    assert problem.value({"height": "9mm", "speed": 0.5}) == expected
    assert problem.value(["9mm", *p[1:]]) == expected
    refused(lambda: problem.value({"hight": 1}), "unknown_key", "p/hight", "height")
    refused(lambda: problem.value({"height": "1kg"}), "wrong_type", "p/height")
    refused(lambda: problem.value("a"), "wrong_type", "p")


def test_values_far_outside_their_bounds_never_reach_the_solver(monkeypatch):
    problem = fettle.DesignProblem(tilted_plate())  # height: 6 to 12 mm
    p = problem.values
    p[0] = 9.0  # millimetres, where metres are wanted
    calls = (
        problem.evaluate, problem.value, problem.value_and_gradient, problem.values_and_jacobians, problem.model_at, problem.relations,
        problem.refusal, problem.check, lambda at: fettle.check_gradients(problem, at),
    )
    monkeypatch.setattr(MeanHeight, "value", lambda *_: pytest.fail("it was simulated"))
    for call in calls:
        refused(lambda: call(p), "out_of_range", "p/height", "9000 mm is far outside its bounds, 6 mm to 12 mm")
    for bad in (float("nan"), float("inf")):
        p[0] = bad
        for call in calls:
            refused(lambda: call(p), "not_finite", "p/height")
    monkeypatch.undo()
    p[0] = 6e-3 - 1e-9  # differences may look beyond a bound
    assert problem.evaluate(p).usable
    assert "out_of_range" in fettle.DesignProblem.__doc__


def test_a_sweep_takes_units_and_stays_near_the_bounds(tmp_path):
    design = tilted_plate()
    design.steps = 2
    found = fettle.explore(design, tmp_path / "sweep.jsonl", sweep={"height": ["7mm", 8e-3]}, workers=1)
    assert sorted(found.column("height")) == [7e-3, 8e-3]
    refused(lambda: fettle.explore(design, tmp_path / "far.jsonl", sweep={"height": [7.0]}), "out_of_range", "p/height", "far outside")
    refused(lambda: fettle.explore(design, tmp_path / "far.jsonl", sweep={"height": ["7kg"]}), "wrong_type", "sweep/height")
    assert not (tmp_path / "far.jsonl").exists()


class Elsewhere:
    """A path that is neither a text nor of pathlib."""

    def __init__(self, path):
        self.path = path

    def __fspath__(self):
        return str(self.path)


@pytest.mark.parametrize("kind", (str, pathlib.Path, Elsewhere))
def test_paths_of_any_kind(tmp_path, kind):
    at = lambda name: kind(tmp_path / name)  # noqa: E731
    file = fettle.read_design(kind(DESIGN), mesh_dirs=[kind(tmp_path)])
    scene = fettle.read_scene(kind(DESIGN.with_name("slider_crank.scene.json")), [kind(tmp_path)])
    text = DESIGN.with_name("slider_crank.scene.json").read_text()
    assert len(fettle.parse_scene(text, kind(DESIGN), [kind(tmp_path)]).bodies) == len(scene.bodies)
    assert fettle.parse_design(DESIGN.read_text(), kind(DESIGN), [kind(tmp_path)]).design == file.design
    assert fettle.design_text(file, [p.value for p in file.design.parameters], kind(tmp_path))
    model = falling_cube()
    trajectory = fettle.simulate(model, steps=2).trajectory
    fettle.write_trajectory(at("a.trajectory.json"), trajectory, model, at("a.scene.json"))
    assert fettle.read_trajectory(at("a.trajectory.json"))[0] == trajectory
    certificate, ranges = fettle.Certificate(), fettle.Certificate()
    fettle.certify_clearance(model, certificate=certificate)
    certificate.write(at("a.certificate.json"))
    assert fettle.Certificate.read(at("a.certificate.json")).check(model, fettle.as_assembled(model)).accepted
    ranges.write(at("b.certificate.json"))
    assert fettle.Certificate.read(at("b.certificate.json"))
    (stl,) = fettle.export_files(at("."), "stl", model, stem="two")
    assert len(fettle.read_mesh(kind(stl), unit="mm").triangles) == 24
    short = tmp_path / "short.design.json"
    scene_path = DESIGN.with_name("slider_crank.scene.json")
    short.write_text(DESIGN.read_text().replace('"from": 0.1, ', "").replace('"scene": "slider_crank.scene.json"', f'"scene": "{scene_path}", "simulation": {{"steps": 1}}'))
    fettle.optimise_file(kind(short), at("out"), max_evaluations=1, report=False)
    assert fettle.write_report(at("out"), at("report.html")) == str(tmp_path / "report.html")
    explored = fettle.explore(kind(short), at("explored.jsonl"), samples=1, workers=1)
    assert len(fettle.read_exploration(at("explored.jsonl"))) == len(explored) == 1
    program = fettle.MeshProgram(["openscad", "-o", "{out}", kind("rod.scad")], directory=at("parts"))
    body = fettle.Body("rod", mesh=box(0.01, 0.01, 0.01), shape=fettle.ShapeSpec(program=program))
    passed = fettle_for_tests.scene_round_trip(fettle.Scene(path=at("a.scene.json"), bodies=[body]))
    assert passed.path == str(tmp_path / "a.scene.json")
    assert passed.bodies[0].shape.program.command[-1] == "rod.scad" and passed.bodies[0].shape.program.directory == str(tmp_path / "parts")
    view = fettle.view(model)
    assert view.save(at("view.html")) == str(tmp_path / "view.html")
