# SPDX-License-Identifier: MIT
"""A shape of one's own, optimised: the heaviest square peg that keeps 0.3 mm of certified clearance to a wall, its head at least 1.2 times
as wide as its foot."""
import numpy as np

import fettle

UNIT, _ = fettle.Part("box", {"size_x": 2, "size_y": 2, "size_z": 0.01}).at({})


class Peg(fettle.Shape):
    """A frustum about the origin, 10 mm high: half widths at the foot and at the top. Vertices are linear in both."""

    def dimensions(self):
        return {"foot": 0.004, "top": 0.005}

    def at(self, values):
        if min(values.values()) <= 0:
            raise ValueError("a peg's widths are above 0")
        foot, flat = UNIT.vertices[:, 2:] < 0, UNIT.vertices * [1, 1, 0]
        jacobian = {"foot": np.where(foot, flat, 0), "top": np.where(foot, 0, flat)}
        vertices = UNIT.vertices * [0, 0, 1] + sum(values[name] * jacobian[name] for name in values)
        return fettle.Mesh("peg", vertices, UNIT.triangles), jacobian


design = fettle.Design(steps=1)
wall = fettle.Body("wall", type="static", prescribed=fettle.held())
wall.pose.position = [0.015, 0, 0]  # its face stands at x = 10 mm
fettle.add_part(design, fettle.Body("peg"), Peg())
fettle.add_part(design, wall, fettle.Part("box", {"size_x": 0.01, "size_y": 0.04, "size_z": 0.04}))
design.parameters = [
    fettle.Parameter("foot", 0.004, 0.002, 0.012, "mm"),
    fettle.Parameter("top", 0.005, 0.002, 0.012, "mm"),
]
design.set("/bodies/peg/shape/dimensions/foot", "foot")
design.set("/bodies/peg/shape/dimensions/top", "top")
design.objective = [fettle.ObjectiveTerm("mass", -1, 1e-3, fettle.Mass([(0, "volume")]))]
design.constraints = [fettle.Constraint("clearance", fettle.Bounds(lower=0.3e-3, margin=1e-7, unit=1e-3), fettle.Clearance(0, 1))]
design.relations = [fettle.Relation("head", fettle.Bounds(lower=1.2, margin=1e-5), formula="top / foot")]

problem = fettle.DesignProblem(design)
outcome = fettle.optimise(problem)
foot, top = 1000 * outcome.report.point
certified = 1000 * outcome.final.constraints[0].lower
print(f"{outcome.report.status}: foot {foot:.4f} mm, top {top:.4f} mm, certified clearance {certified:.4f} mm")
assert outcome.report.feasible and top > 9.6 and foot < 8.1
