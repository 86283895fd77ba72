# SPDX-License-Identifier: MIT
"""A design made in memory, with a quantity of its own: the mean height of a brick on a table that a motor tilts, and its derivatives by the
brick's length and the motor's speed, through the whole simulation, beside differences of whole simulations."""
import numpy as np

import fettle


class MeanHeight(fettle.Quantity):
    """Mean height of a body's reference point over the motion."""

    dimension = "length"

    def __init__(self, body):
        self.body = body

    def value(self, simulated):
        return simulated.positions[:, self.body, 2].mean()

    def gradient(self, simulated):
        positions = np.zeros_like(simulated.positions)
        positions[:, self.body, 2] = 1 / len(positions)
        return fettle.QuantityGradient(positions=positions)


def box(x, y, z):
    return fettle.Part("box", {"size_x": x, "size_y": y, "size_z": z})


design = fettle.Design(scene=fettle.Scene(gravity=[0, 0, -9.81], timestep=0.005), steps=12)
table = fettle.Body("table", type="kinematic", prescribed=fettle.held())
table.prescribed[4].rate = 0.7  # a motor tilts it
table.pose.position = [0, 0, -0.005]
brick = fettle.Body("brick")
brick.pose.position = [0.003, 0.001, 0.00512]
fettle.add_part(design, table, box(0.06, 0.06, 0.01))
fettle.add_part(design, brick, box(0.02, 0.012, 0.01))
design.parameters = [
    fettle.Parameter("length", 0.02, 0.015, 0.03, "mm"),
    fettle.Parameter("speed", 0.7, 0.2, 1.0, "rad/s"),
]
design.set("/bodies/brick/shape/dimensions/size_x", "length")
design.set("/bodies/table/prescribed/ry/rate", "speed")
design.objective = [fettle.ObjectiveTerm("height", 1, 1e-3, MeanHeight(1))]  # in mm

problem = fettle.DesignProblem(design)
print(f"mean height {problem.value(problem.values):.6f} mm")
report = fettle.check_gradients(problem)
for row in report.rows:
    print(f"d/d {row.parameter}: {row.adjoint:.9g}, by differences {row.difference:.9g}")
assert report.largest_relative_error < 1e-5
