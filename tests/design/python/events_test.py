# SPDX-License-Identifier: MIT
"""When something happens, what is then, and for how long: events of an arm that turns by 900 degrees a second."""
import dataclasses
import pickle

import numpy as np
import pytest

import fettle
import fettle_for_tests
from records_test import EVERY_QUANTITY

DEGREE = np.pi / 180
SPEED = 900 * DEGREE
TURN = fettle.BodyTurn("arm", [0, 0, 1])


def turning_arm(*quantities):
    design = fettle.read_design(str(EVERY_QUANTITY)).design
    free = fettle.Bounds(lower=-1e9)
    constraints = [fettle.Constraint(f"c{k}", free, quantity) for k, quantity in enumerate(quantities)]
    return dataclasses.replace(design, objective=[], constraints=constraints)


def evaluated(*quantities):
    design = turning_arm(*quantities)
    problem = fettle.DesignProblem(design)
    assert fettle_for_tests.design_round_trip(problem.design) == problem.design
    assert pickle.loads(pickle.dumps(problem.design)) == problem.design
    return problem.evaluate(problem.values)


def test_events_and_formulas_of_them():
    first, second = (fettle.EventTime(TURN, threshold=angle) for angle in ("10deg", "30deg"))
    at = evaluated(first, second - first, fettle.ValueAt(TURN, (first + second) / 2), fettle.TimeShare(TURN, "9deg"),
                   fettle.TimeShare(TURN, "9deg", above=False, along=TURN), fettle.Worst([first, second]),
                   fettle.EventTime(fettle.StepExpression(2 * TURN), "10deg", "rising", -1))
    assert at.usable, at.reason
    expected = [10 * DEGREE / SPEED, 20 * DEGREE / SPEED, 20 * DEGREE, 0.8, 0.2, 30 * DEGREE / SPEED, 5 * DEGREE / SPEED]
    assert [c.value for c in at.constraints] == pytest.approx(expected, rel=1e-6)


def test_a_threshold_that_follows_from_a_parameter():
    length = fettle.read_design(str(EVERY_QUANTITY)).design.parameters[0]
    height = fettle.MarkerPosition("arm", [20e-3, 0, 0], axis=[0, 1, 0])
    at = evaluated(fettle.EventTime(height, length / 4))
    assert at.usable, at.reason
    assert at.constraints[0].value == pytest.approx(30 * DEGREE / SPEED, rel=1e-3)
    assert at.jacobian[0, 0] == pytest.approx(0.25 / (20e-3 * np.cos(30 * DEGREE) * SPEED), rel=2e-2)


def test_an_event_that_does_not_happen():
    at = evaluated(fettle.EventTime(TURN, "90deg"))
    assert not at.usable
    assert "crosses 90 deg at no time in this motion: it comes nearest at 0.05 s, with 45 deg" in at.reason


def test_what_cannot_be_is_refused():
    for quantity, code, message in (
        (fettle.EventTime(fettle.Mass([("arm", "volume")])), "unsupported", "each step has a number of"),
        (fettle.EventTime(TURN, "3 mm"), "wrong_type", "a unit of length was given, angle is expected"),
        (fettle.EventTime(TURN, occurrence=0), "out_of_range", "0 is none"),
        (fettle.EventTime(fettle.BodyTurn("arm", [0, 0, 1], "largest")), "unsupported", "leave out what is taken over them"),
        (fettle.ValueAt(TURN, TURN), "wrong_type", "the time of an event"),
        (fettle.EventTime(TURN, float("nan")), "not_finite", "threshold: it is NaN"),
    ):
        with pytest.raises(fettle.Error, match=message) as found:
            fettle.DesignProblem(turning_arm(quantity))
        assert found.value.code == code
