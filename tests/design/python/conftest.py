# SPDX-License-Identifier: MIT
"""Parts and designs that several tests use. SI units."""
import pathlib

import numpy as np
import pytest

import fettle

def pytest_configure(config):
    """Marks that tests use."""
    config.addinivalue_line("markers", "programs: runs OpenSCAD, or a Dask cluster")


ROOT = pathlib.Path(__file__).resolve().parents[3]
EXAMPLES = ROOT / "examples"

CORNERS = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)], float)
BOX_TRIANGLES = np.array(
    [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4], [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]]
)


def box(x, y, z, name="box"):
    """A box about the origin with these edges."""
    return fettle.Mesh(name, CORNERS * np.array([x, y, z]) / 2, BOX_TRIANGLES)


class Frustum(fettle.Shape):
    """A truncated pyramid about the origin: half widths at the foot and at the top, height."""

    def __init__(self, foot, top, height):
        self.drawn = {"foot": foot, "top": top, "height": height}

    def dimensions(self):
        return self.drawn

    def at(self, values):
        if min(values.values()) <= 0:
            raise ValueError("a frustum's dimensions are above 0")
        low = CORNERS[:, 2] < 0
        flat = CORNERS * [1, 1, 0]
        derivative = {
            "foot": np.where(low[:, None], flat, 0),
            "top": np.where(low[:, None], 0, flat),
            "height": CORNERS * [0, 0, 0.5],
        }
        vertices = sum(values[name] * derivative[name] for name in values)
        return fettle.Mesh("frustum", vertices, BOX_TRIANGLES), derivative


class MeanHeight(fettle.Quantity):
    """Mean height of a body's reference point over the motion, and a quarter of its eighth vertex' height in the body."""

    dimension = "length"

    def __init__(self, body):
        self.body = body

    def value(self, simulated):
        return simulated.positions[:, self.body, 2].mean() + 0.25 * simulated.vertices(self.body)[7, 2]

    def gradient(self, simulated):
        positions = np.zeros_like(simulated.positions)
        positions[:, self.body, 2] = 1 / len(positions)
        vertices = np.zeros_like(simulated.vertices(self.body))
        vertices[7, 2] = 0.25
        return fettle.QuantityGradient(positions=positions, vertices={self.body: vertices})


def tilted_plate(quantity=None, shape=None):
    """A frustum falls 0.02 mm onto a plate that a motor tilts; the design of the library's memory_design_test."""
    plate = fettle.Body("plate", type="kinematic", mesh=box(0.06, 0.06, 0.01), prescribed=fettle.held())
    plate.pose.position = [0, 0, -5e-3]
    plate.reference_point = [0, 0, 5e-3]
    plate.prescribed[4].rate = 0.7
    design = fettle.Design(scene=fettle.Scene(bodies=[plate], gravity=[0, 0, -9.81], timestep=0.005, dhat=1e-4), steps=12)
    part = fettle.Body("part", angular_velocity=[8, 5, 0])
    part.pose.position = [2e-3, 1e-3, 4.12e-3]
    assert fettle.add_part(design, part, shape or Frustum(8e-3, 5e-3, 8e-3)) == 1
    height = fettle.Parameter("height", 8e-3, 6e-3, 12e-3, "mm")
    design.parameters = [
        height,
        fettle.Parameter("foot", 8e-3, 6e-3, 10e-3, "mm"),
        fettle.Parameter("top", 5e-3, 2e-3, 9e-3, "mm"),
        fettle.Parameter("speed", 0.7, 0.2, 1, "rad/s"),
    ]
    design.set("/bodies/1/shape/dimensions/height", height)
    design.set("/bodies/1/position/2", height / 2 + 1.2e-4)
    design.set("/bodies/1/shape/dimensions/foot", "foot")
    design.set("/bodies/1/shape/dimensions/top", "top")
    design.set("/bodies/0/prescribed/ry/rate", "speed")
    measured = quantity or MeanHeight(1)
    design.objective = [
        fettle.ObjectiveTerm("height", -1, 1e-3, measured),
        fettle.ObjectiveTerm("mass", 1, 1e-3, fettle.Mass([(1, "volume")])),
    ]
    design.constraints = [fettle.Constraint("height", fettle.Bounds(lower=3.9e-3, unit=1e-3), measured)]
    design.optimiser = fettle.OptimiserSettings("mma", 6, 1e-4)
    return design


@pytest.fixture(name="tilted")
def tilted_fixture():
    return fettle.DesignProblem(tilted_plate())
