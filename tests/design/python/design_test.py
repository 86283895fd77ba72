# SPDX-License-Identifier: MIT
"""Designs in memory with a shape and a quantity of one's own: evaluated, audited, optimised, used by SciPy."""
import json
import pickle
import threading

import numpy as np
import pytest

import fettle
from conftest import EXAMPLES, Frustum, MeanHeight, tilted_plate


def test_evaluated_and_differentiated(tilted):
    at = tilted.evaluate(tilted.values)
    assert at.usable, at.reason
    assert at.constraints[0].value == pytest.approx(at.terms[0].value)
    value, gradient = tilted.value_and_gradient(tilted.values)
    assert value == at.objective
    assert np.array_equal(gradient, at.gradient)
    assert tilted.value(tilted.values) == value
    report = fettle.check_gradients(tilted)
    assert not report.failures
    assert len(report.rows) == 8
    for row in report.rows:
        assert row.relative_error < 1e-6, row
        assert row.adjoint != 0
    assert [row.quantity for row in report.along] == ["objective", report.rows[-1].quantity]
    assert report.sweeps.disagreement < 1e-9 and not report.sweeps.failure
    assert report.contacts_reach.shape == (4, 2)
    assert report.roughness.measured and len(report.roughness.quantities) == 2
    for change in report.contact_changes:
        assert {change.body_a, change.body_b} == {"plate", "part"}
        assert abs(change.from_) < abs(change.to)
    assert pickle.loads(pickle.dumps(report)) == report
    some = fettle.check_gradients(tilted, most_parameters=1)
    assert len(some.left_out) == 3 and {row.parameter for row in some.rows}.isdisjoint(some.left_out)
    assert pickle.loads(pickle.dumps(at)) == at


def test_the_mass_is_known(tilted):
    # A frustum of half widths a, b and height h: h (4a^2 + 4ab + 4b^2)/3.
    h, a, b = 8e-3, 8e-3, 5e-3
    assert tilted.evaluate(tilted.values).terms[1].value == pytest.approx(1000 * h * 4 * (a * a + a * b + b * b) / 3)


def test_the_peak_is_the_largest_absolute_value():
    design = tilted_plate()
    design.constraints = [
        fettle.Constraint(f"{over} {sign}", fettle.Bounds(lower=-10), fettle.MarkerSpeed("part", [0, 0, 0], over, [0, 0, sign]))
        for sign in (1, -1)
        for over in ("largest", "least", "peak")
    ]
    problem = fettle.DesignProblem(design)
    at = problem.evaluate(problem.values)
    assert at.usable, at.reason
    for largest, least, peak in np.reshape([c.value for c in at.constraints], (2, 3)):
        assert peak == max(largest, -least) > 0


def test_optimised_and_again_the_same_bits(tilted):
    lines = []
    outcome = fettle.optimise(tilted, progress=lines.append)
    assert outcome.report.evaluations > 2
    assert outcome.final.objective < tilted.value(tilted.values)
    assert outcome.final.usable
    assert outcome.report.objective == outcome.final.objective
    assert outcome.report.violation == outcome.final.violation == 0 and outcome.report.feasible
    assert lines
    again = fettle.optimise(fettle.DesignProblem(tilted_plate()))
    assert np.array_equal(again.report.point, outcome.report.point)
    assert pickle.loads(pickle.dumps(again)).report == again.report


def with_wide_foot():
    """The tilted plate, whose bounds allow for a part that cannot be made."""
    design = tilted_plate()
    design.parameters[1].lower = "-1mm"
    return design


def test_a_shape_refuses_and_a_quantity_raises():
    tilted = fettle.DesignProblem(with_wide_foot())
    p = tilted.values
    p[1] = -1e-3
    at = tilted.evaluate(p)
    assert not at.usable
    assert np.isnan(at.objective) and np.isnan(at.violation)  # no number stands in for what is not known
    assert "part" in at.reason and "above 0" in at.reason
    with pytest.raises(fettle.EvaluationError, match="above 0"):
        tilted.value_and_gradient(p)

    class Broken(MeanHeight):
        def value(self, simulated):
            raise ZeroDivisionError("mine")

    problem = fettle.DesignProblem(tilted_plate(Broken(1)))
    with pytest.raises(ZeroDivisionError, match="mine"):
        problem.value(problem.values)
    with pytest.raises(ZeroDivisionError, match="mine"):
        fettle.optimise(problem)

    class Wrong(MeanHeight):
        def gradient(self, simulated):
            return fettle.QuantityGradient(positions=np.zeros((2, 2, 3)))

    problem = fettle.DesignProblem(tilted_plate(Wrong(1)))
    with pytest.raises(ValueError, match="steps . 1, bodies, 3"):
        problem.value_and_gradient(problem.values)


def test_a_wrong_gradient_is_found():
    class Doubled(MeanHeight):
        def gradient(self, simulated):
            right = super().gradient(simulated)
            return fettle.QuantityGradient(2 * right.positions, vertices=right.vertices)

    report = fettle.check_gradients(fettle.DesignProblem(tilted_plate(Doubled(1))))
    assert report.largest_relative_error > 0.1


def test_what_a_quantity_sees_ends_with_the_call():
    kept = []

    class Keeping(MeanHeight):
        def value(self, simulated):
            kept.append((simulated, simulated.positions))
            return super().value(simulated)

    problem = fettle.DesignProblem(tilted_plate(Keeping(1)))
    problem.value(problem.values)
    simulated, positions = kept[-1]
    assert np.all(np.isfinite(positions))
    with pytest.raises(RuntimeError, match="while value"):
        _ = simulated.positions


class TimedPath(fettle.Quantity):
    """fettle.MarkerPath of a body's reference point with a target at each configuration, written in Python."""

    dimension = "area"

    def __init__(self, body, targets):
        self.body, self.targets = body, np.asarray(targets)

    def away(self, simulated):
        return (simulated.positions[:, self.body] - self.targets).ravel() / np.sqrt(len(self.targets))

    def value(self, simulated):
        return float(self.away(simulated) @ self.away(simulated))

    def gradient(self, simulated):
        return self.weighted(simulated, 2 * self.away(simulated))

    def deviations(self, simulated):
        return self.away(simulated)

    def deviation_gradient(self, simulated, i):
        return self.weighted(simulated, np.eye(self.targets.size)[i])

    def weighted(self, simulated, weights):
        positions = np.zeros_like(simulated.positions)
        positions[:, self.body] = weights.reshape(-1, 3) / np.sqrt(len(self.targets))
        return fettle.QuantityGradient(positions=positions)


def path_design(kind):
    """The tilted plate's part on a path of 13 points."""
    design = tilted_plate()
    times = 0.005 * np.arange(13)
    targets = np.array([2e-3, 1e-3, 4.2e-3]) + np.outer(times, [0.01, -0.02, 0.03])
    if kind == "own":
        quantity = TimedPath(1, targets)
    else:
        built = fettle.build_model(design.scene)
        quantity = fettle.MarkerPath(1, built.reference_points[1], targets, times)
    design.objective = [fettle.ObjectiveTerm("path", 2.0, 1e-6, quantity)]
    design.constraints = []
    return design


def test_deviations_of_an_own_quantity_are_the_librarys():
    """A sum of squares written in Python gives Gauss-Newton's rows as the library's own quantity does."""
    own, known = (fettle.DesignProblem(path_design(kind)) for kind in ("own", "known"))
    at, expected = own.evaluate(own.values), known.evaluate(known.values)
    assert expected.residuals.size == 39 and np.all(np.any(expected.residual_jacobian != 0, axis=0))
    assert at.objective == pytest.approx(expected.objective, rel=1e-9)
    assert at.residuals == pytest.approx(expected.residuals, rel=1e-9, abs=1e-12)
    scale = np.abs(expected.residual_jacobian).max(axis=0)
    assert np.allclose(at.residual_jacobian / scale, expected.residual_jacobian / scale, rtol=0, atol=1e-9)
    assert at.gradient == pytest.approx(2 * at.residual_jacobian.T @ at.residuals, rel=1e-9)


def test_wrong_deviations_are_refused():
    class Unsquared(TimedPath):
        def deviations(self, simulated):
            return 2 * self.away(simulated)

    class Flat(TimedPath):
        def deviations(self, simulated):
            return self.value(simulated)

    class Ungiven(TimedPath):
        deviation_gradient = fettle.Quantity.deviation_gradient

    class Endless(TimedPath):
        def deviation_gradient(self, simulated, i):
            return self.weighted(simulated, np.full(self.targets.size, np.nan))

    faults = [
        (Unsquared, fettle.Error, "sum up to its value"),
        (Flat, fettle.Error, "shape .m,."),
        (Ungiven, NotImplementedError, ""),
        (Endless, fettle.Error, "Endless.deviation_gradient../positions: it has a number that is not finite"),
    ]
    for kind, error, words in faults:
        design = path_design("own")
        design.objective[0].quantity = kind(1, design.objective[0].quantity.targets)
        problem = fettle.DesignProblem(design)
        with pytest.raises(error, match=words):
            problem.value_and_gradient(problem.values)


def test_an_own_quantity_can_tell_bounds():
    class Rounded(MeanHeight):
        def __init__(self, body, down, up):
            super().__init__(body)
            self.down, self.up = down, up

        def value(self, simulated):
            found = super().value(simulated)
            return fettle.Measurement(found, found - self.down, found + self.up)

    plain = fettle.DesignProblem(tilted_plate())
    expected = plain.evaluate(plain.values)
    problem = fettle.DesignProblem(tilted_plate(Rounded(1, 1e-3, 2e-3)))
    at = problem.evaluate(problem.values)
    height = expected.constraints[0].value
    assert at.constraints[0] == fettle.Measurement(height, height - 1e-3, height + 2e-3)
    assert np.array_equal(at.gradient, expected.gradient)
    assert at.violation == pytest.approx(max(0, 3.9e-3 - (height - 1e-3)) / 1e-3) and at.violation > expected.violation
    for down, up in ((-1e-3, 2e-3), (1e-3, float("nan"))):
        problem = fettle.DesignProblem(tilted_plate(Rounded(1, down, up)))
        with pytest.raises(ValueError, match="between its lower and its upper bound"):
            problem.value(problem.values)


def test_threads_share_a_problem(tilted):
    expected = tilted.value_and_gradient(tilted.values)[1]
    found = [None] * 4

    def work(i):
        found[i] = tilted.value_and_gradient(tilted.values)[1]

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(one, expected) for one in found)


def test_relations_as_formula_and_as_function_agree():
    design = tilted_plate()
    bounds = fettle.Bounds(lower=0.6, margin=1e-5)
    design.relations = [
        fettle.Relation("formula", bounds, formula="top / foot"),
        fettle.Relation("function", bounds, at=lambda p: (p[2] / p[1], [0, -p[2] / p[1] ** 2, 1 / p[1], 0])),
    ]
    problem = fettle.DesignProblem(design)
    rows = problem.relations(problem.values)
    assert rows.values == pytest.approx([0.625, 0.625], rel=1e-15)
    assert rows.jacobian[0] == pytest.approx(rows.jacobian[1], rel=1e-14)
    design.relations = [fettle.Relation("formula", bounds, formula="tap / foot")]
    with pytest.raises(fettle.Error, match="tap"):
        fettle.DesignProblem(design)


def test_a_part_of_a_file_is_one_of_the_library_or_of_ones_own():
    assert {"box", "cylinder", "geneva_wheel"} <= set(fettle.parts()) and all(fettle.parts().values())
    crank = fettle.Part(str(EXAMPLES / "slider_crank" / "crank.part.json"), {"crank_radius": "14mm"})
    assert crank.dimensions()["crank_radius"] == 14e-3 and crank.dimensions()["disc_top"] == pytest.approx(-2.4e-3)
    few, many = (fettle.Part("cylinder", counts={"segments": n}).at({})[0] for n in (8, 24))
    assert (len(few.vertices), len(many.vertices)) == (16, 48) and few.deviation.inside > many.deviation.inside > 0
    assert fettle.Part("cylinder", chord="1um").at({})[0].deviation.inside < 1.001e-6
    with pytest.raises(fettle.Error, match="there is no part"):
        fettle.Part("cilinder").at({})


def test_parts_of_files_have_their_derivative():
    part = fettle.Part("bell_crank")
    drawn = part.dimensions()
    mesh, jacobian = part.at({})
    step = 1e-6
    for name in drawn:
        ends = [part.at({name: drawn[name] + sign * step})[0].vertices for sign in (1, -1)]
        assert np.allclose((ends[0] - ends[1]) / (2 * step), jacobian[name], atol=1e-6), name
    with pytest.raises(fettle.Error) as refused:
        part.at({next(iter(drawn)): -1.0})
    assert refused.value.code == "out_of_range"


def test_a_file_is_optimised_into_a_folder(tmp_path):
    text = (EXAMPLES / "slider_crank" / "slider_crank.design.json").read_text()
    path = tmp_path / "short.design.json"
    scene = EXAMPLES / "slider_crank" / "slider_crank.scene.json"
    path.write_text(text.replace('"from": 0.1, ', "").replace('"scene": "slider_crank.scene.json"', f'"scene": "{scene}", "simulation": {{"steps": 3}}'))
    file = fettle.read_design(str(path))
    outcome = fettle.optimise_file(str(path), str(tmp_path / "out"), max_evaluations=6)
    assert 0 < outcome.report.evaluations < 12
    for left in ("history.jsonl", "motion.glb", "result.json", "report.html"):
        assert (tmp_path / "out" / left).stat().st_size > 0, left
    told = json.loads((tmp_path / "out" / "result.json").read_text())
    assert told["evaluations"] == outcome.report.evaluations and told["command"].startswith("fettle.optimise_file")
    resolution = told["resolution"]
    assert set(resolution) == {"runs", "terms", "constraints", "flips"}
    keys = [run["run"] for run in resolution["runs"]]
    assert keys == ["finer_facets", "finer_steps"]
    assert all({"run", "objective", "change_of_best"} <= set(run) for run in resolution["runs"])
    assert [each["name"] for each in resolution["constraints"]] == [each["name"] for each in told["constraints"]]
    assert [each["name"] for each in resolution["terms"]] == [each["name"] for each in told["terms"]]
    for each in resolution["terms"] + resolution["constraints"]:
        assert {"name", "found", "change", *keys} <= set(each)
    for each, judged in zip(resolution["constraints"], told["constraints"]):
        assert each["met"] == judged["met"] and each["met_finer"] in (True, False)
        values = [each["found"], *(each[key] for key in keys)]
        assert each["change"] == pytest.approx(max(abs(v - each["found"]) / max(abs(v), abs(each["found"])) if v != each["found"] else 0 for v in values))
    assert set(resolution["flips"]) <= {each["name"] for each in resolution["constraints"]}
    assert fettle.write_report(str(tmp_path / "out"), str(tmp_path / "again.html")) == str(tmp_path / "again.html")
    assert "<html" in (tmp_path / "again.html").read_text()
    final = fettle.read_design(str(tmp_path / "out" / "design.final.json"))
    assert [p.name for p in final.design.parameters] == [p.name for p in file.design.parameters]
    again = fettle.optimise_file(str(path), str(tmp_path / "out"), resume=True, max_evaluations=6)
    assert again.replayed > 0
    assert np.array_equal(again.report.point, outcome.report.point)


def test_scipy_minimises_a_design():
    optimize = pytest.importorskip("scipy.optimize")
    design = tilted_plate()
    design.objective = [fettle.ObjectiveTerm("mass", 1, 1e-3, fettle.Mass([(1, "volume")]))]
    design.constraints, design.steps = [], 1
    problem = fettle.DesignProblem(design)
    lower, width = problem.lower, problem.upper - problem.lower

    def scaled(u):
        value, gradient = problem.value_and_gradient(lower + u * width)
        return value, gradient * width

    found = optimize.minimize(scaled, (problem.values - lower) / width, jac=True, bounds=[(0, 1)] * 4, method="L-BFGS-B")
    assert found.success
    assert found.x[:3] == pytest.approx([0, 0, 0], abs=1e-9)  # the least frustum


def test_frustum_is_a_shape_of_the_library():
    mesh, jacobian = fettle.shape_at(Frustum(8e-3, 5e-3, 8e-3), {"height": 9e-3})
    assert mesh.vertices[:, 2].max() == pytest.approx(4.5e-3)
    assert set(jacobian) == {"foot", "top", "height"}
