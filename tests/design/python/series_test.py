# SPDX-License-Identifier: MIT
"""What each instant has a number of: derivatives in time, windows, and expressions over the steps. What they come to is tested in C++."""
import pickle

import numpy as np
import pytest

import fettle
from conftest import tilted_plate
from refusals_test import refused

POINT, Z = np.array([1e-3, 2e-3, 0]), np.array([0, 0, 1.0])


class Watch(fettle.Quantity):
    """Keeps the times, and where POINT of the part is."""

    def value(self, simulated):
        self.times = simulated.times
        self.places = simulated.positions[:, 1] + simulated.rotations[:, 1] @ (POINT - simulated.reference_points[1])
        return 1.0

    def gradient(self, simulated):
        return fettle.QuantityGradient()


def measured(**quantities):
    """The quantities as the problem has them, their values, and what they follow from."""
    design, watch = tilted_plate(), Watch()
    design.constraints = [fettle.Constraint(name, quantity=of) for name, of in {**quantities, "watch": watch}.items()]
    problem = fettle.DesignProblem(design)
    at = problem.evaluate(problem.values)
    assert at.usable, at.reason
    assert np.isfinite(at.jacobian).all()
    passed = {c.name: c.quantity for c in problem.design.constraints}
    return passed, {name: m.value for name, m in zip(passed, at.constraints)}, watch


def test_windows_and_derivatives():
    def height(*over, **words):
        return fettle.MarkerPosition("part", POINT, *over, axis=Z, **words)

    passed, found, watch = measured(
        last=height(), mean=height("mean", from_time="25 ms", to_time=0.05), middle=height(at=0.0325), slope=height(derivative=1, at="30 ms"),
        rms=height("rms"), bend=fettle.MarkerPosition("part", POINT, derivative=2, at=0.03), far=fettle.MarkerPosition("part", POINT, origin=[0, 0, 1]))
    z, h = watch.places[:, 2], 0.005
    assert found["last"] == pytest.approx(z[-1], rel=1e-12)
    assert found["mean"] == pytest.approx(z[5:11].mean(), rel=1e-12)
    assert found["middle"] == pytest.approx((z[6] + z[7]) / 2, rel=1e-12)
    assert found["slope"] == pytest.approx((z[7] - z[5]) / (2 * h), rel=1e-9)
    assert found["rms"] == pytest.approx(np.sqrt((z**2).mean()), rel=1e-12)
    assert found["bend"] == pytest.approx(np.linalg.norm(watch.places[7] - 2 * watch.places[6] + watch.places[5]) / h**2, rel=1e-6)
    assert found["far"] == pytest.approx(np.linalg.norm(watch.places[-1] - Z), rel=1e-12)
    assert passed["mean"] == fettle.MarkerPosition(1, POINT, "mean", Z, from_time=0.025, to_time=0.05)
    assert (passed["bend"].derivative, passed["bend"].at, passed["bend"].to_time) == (2, 0.03, None)
    assert pickle.loads(pickle.dumps(passed["mean"])) == passed["mean"]
    assert [fettle.quantity_dimension(passed[name]) for name in ("last", "slope", "bend")] == ["length", "speed", "acceleration"]


def test_expressions_over_the_steps():
    z, most = fettle.MarkerPosition("part", POINT, axis=Z), fettle.MarkerPosition("part", POINT, "largest", axis=Z)
    passed, found, watch = measured(
        most=most, twice=fettle.StepExpression(2 * z, over="largest"), law=fettle.StepExpression("z - 3 mm/s * time", {"z": z}, "rms"),
        root=fettle.StepExpression("z * z / most", {"z": z, "most": most}, over="mean"), size=fettle.StepExpression("z / height", {"z": z}))
    heights = watch.places[:, 2]
    assert found["twice"] == pytest.approx(2 * found["most"], rel=1e-12)
    assert found["law"] == pytest.approx(np.sqrt(((heights - 3e-3 * watch.times) ** 2).mean()), rel=1e-12)
    assert found["root"] == pytest.approx((heights**2).mean() / found["most"], rel=1e-12)
    assert found["size"] == pytest.approx(heights[-1] / 8e-3, rel=1e-12)
    assert isinstance(passed["twice"], fettle.StepExpression) and passed["twice"].over == "largest"
    assert [type(part) for part in passed["root"].parts.values()] == [fettle.MarkerPosition] * 2
    assert pickle.loads(pickle.dumps(passed["law"])) == passed["law"]


class LastHeight(fettle.Quantity):
    """Where the part's reference point is in the end, which a law or an expression over the steps may be compared with."""

    dimension = "length"
    is_number = True

    def value(self, simulated):
        return simulated.positions[-1, 1, 2]

    def gradient(self, simulated):
        positions = np.zeros_like(simulated.positions)
        positions[-1, 1, 2] = 1
        return fettle.QuantityGradient(positions=positions)


def test_an_own_number_stands_in_an_expression_over_the_steps():
    z, own, design = fettle.MarkerPosition("part", POINT, axis=Z), LastHeight(), tilted_plate()
    step = fettle.StepExpression("2 * z - own", {"z": z, "own": own})
    design.constraints = [fettle.Constraint(name, quantity=of) for name, of in {"z": z, "own": own, "step": step}.items()]
    problem = fettle.DesignProblem(design)
    at = problem.evaluate(problem.values)
    value = [measured.value for measured in at.constraints]
    assert value[2] == pytest.approx(2 * value[0] - value[1], rel=1e-12)
    assert np.any(at.jacobian[1] != 0)
    assert at.jacobian[2] == pytest.approx(2 * at.jacobian[0] - at.jacobian[1], rel=1e-9)

    class Bounded(LastHeight):
        def value(self, simulated):
            return fettle.Measurement(0, -1, 1)

    design.constraints[1].quantity = Bounded()
    problem = fettle.DesignProblem(design)
    with pytest.raises(fettle.Error, match="says that it `is_number`"):
        problem.evaluate(problem.values)
    own.is_number = False
    refused(lambda: fettle.DesignProblem(design), "unsupported", "constraint `step`/quantity", "cannot stand")


def test_laws():
    z, height = fettle.MarkerPosition("part", POINT, axis=Z), tilted_plate().parameters[0]
    law = fettle.Law("length", [0.01, 0.05], ["1 mm", height / 2])
    passed, found, watch = measured(off=fettle.StepExpression(z - law, over="rms"), law=law)
    wanted = np.interp(watch.times, [0.01, 0.05], [1e-3, 4e-3])
    assert found["off"] == pytest.approx(np.sqrt(((watch.places[:, 2] - wanted) ** 2).mean()), rel=1e-12)
    assert found["law"] == pytest.approx(4e-3) and passed["law"].values[0] == pytest.approx(1e-3)
    assert fettle.quantity_dimension(passed["law"]) == "length"


def test_faults():
    design = tilted_plate()

    def made(quantity):
        design.objective = [fettle.ObjectiveTerm("odd", quantity=quantity)]
        return lambda: fettle.DesignProblem(design)

    z = fettle.MarkerPosition("part", POINT, axis=Z)
    refused(made(fettle.MarkerPosition("part", POINT, from_time=1e3)), "out_of_range", "objective `odd`", "is not within the motion")
    refused(made(fettle.MarkerPosition("part", POINT, "peak", at=0)), "inconsistent", "objective `odd`", "at a time")
    refused(made(fettle.MarkerPosition("part", POINT, derivative=3)), "out_of_range", "objective `odd`", "the first or the second")
    refused(made(fettle.Law("length", [0, 0], [0, 1])), "out_of_range", "objective `odd`", "increase")
    refused(made(fettle.Law("length", [0, 1], ["3 N", 1])), "wrong_type", "Law/values", "a unit of force")
    gap = fettle.Clearance(0, 1)
    refused(made(fettle.StepExpression("gap + z", {"z": z, "gap": gap})), "unsupported", "objective term `odd`/quantity", "cannot stand")
    design.parameters.append(fettle.Parameter("time", 1, 0, 2, "mm"))
    made(fettle.StepExpression("z * 2", {"z": z}))()
    refused(made(fettle.StepExpression("z / time", {"z": z})), "inconsistent", "StepExpression/formula", "rename")
    with pytest.raises(AttributeError, match="from_time"):
        z.form_time = 1
