# SPDX-License-Identifier: MIT
"""Sweeps a certified clearance over two dimensions of the slider-crank, the pins at both ends of its rod, and plots it:
python3 sweep.py [PICTURE] [POINTS PER SIDE]. Nothing is simulated: the fits are judged as assembled."""
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import fettle

picture = sys.argv[1] if len(sys.argv) > 1 else "sweep.png"
points = int(sys.argv[2]) if len(sys.argv) > 2 else 12
examples = pathlib.Path(__file__).resolve().parent.parent
problem = fettle.DesignProblem(fettle.read_design(str(examples / "slider_crank" / "slider_crank.design.json")).design)
names = problem.parameter_names
i, j = names.index("crank_pin_radius"), names.index("wrist_pin_radius")
x, y = (np.linspace(problem.lower[k], problem.upper[k], points) for k in (i, j))

bodies = problem.model_at(problem.values).body_names
crank, rod, piston = (bodies.index(name) for name in ("crank", "rod", "piston"))
fits = [fettle.PairRequest(crank, rod), fettle.PairRequest(rod, piston)]
least = np.full((points, points), np.nan)
for row, column in np.ndindex(least.shape):
    p = problem.values
    p[i], p[j] = x[column], y[row]
    if not problem.refusal(p):
        least[row, column] = min(pair.lower for pair in fettle.certify_clearance(problem.model_at(p), pairs=fits))
print(f"{np.isfinite(least).sum()} of {least.size} designs can be made; proven clearance up to {1e3 * np.nanmax(least):.4f} mm")

figure, axes = plt.subplots(figsize=(6, 4.5), layout="constrained")
contour = axes.contourf(1e3 * x, 1e3 * y, 1e3 * least, 12, cmap="viridis")
figure.colorbar(contour, label="proven clearance [mm]")
axes.set(xlabel=f"{names[i]} [mm]", ylabel=f"{names[j]} [mm]", title="Least clearance at both ends of the rod")
figure.savefig(picture, dpi=120)
