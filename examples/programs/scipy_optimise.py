# SPDX-License-Identifier: MIT
"""A design given to scipy.optimize: the mass of the slider-crank's crank under its certified fits, by SLSQP on values and Jacobians."""
import pathlib

import numpy as np
from scipy.optimize import minimize

import fettle

examples = pathlib.Path(__file__).resolve().parent.parent
design = fettle.read_design(str(examples / "slider_crank" / "slider_crank.design.json")).design
for scenario in design.scenarios:
    scenario.steps = 1


def measured(row):
    """What a row of the design measures, in whichever of its scenarios."""
    return getattr(row.quantity, "quantity", row.quantity)


design.constraints = [c for c in design.constraints if isinstance(measured(c), fettle.Clearance) and not measured(c).motion]
design.objective = [t for t in design.objective if isinstance(measured(t), fettle.Mass)]
problem = fettle.DesignProblem(design)
lower, width = problem.lower, problem.upper - problem.lower  # the optimiser's variables run from 0 to 1
unit = 1e-3  # and its constraints are in mm
required = np.array([c.bounds.lower for c in design.constraints])
last = {}


def at(u):
    """Everything at one point, computed once for the three functions that ask for it."""
    if last.get("u") != tuple(u):
        last.update(u=tuple(u), found=problem.values_and_jacobians(lower + np.clip(u, 0, 1) * width))
    return last["found"]


found = minimize(
    lambda u: (at(u)[0], at(u)[1] * width),
    (problem.values - lower) / width,
    jac=True,
    method="SLSQP",
    bounds=[(0, 1)] * len(lower),
    constraints={"type": "ineq", "fun": lambda u: (at(u)[2] - required) / unit - 1e-4, "jac": lambda u: at(u)[3] * width / unit},
    options={"maxiter": 60, "ftol": 1e-9},
)
final = problem.evaluate(lower + found.x * width)
proven = min(m.lower - r for m, r in zip(final.constraints, required))
print(f"{found.message}: objective {final.objective:.6g}, every fit is proven with {1e6 * proven:.3f} um to spare")
assert final.violation == 0
