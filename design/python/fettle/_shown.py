# SPDX-License-Identifier: MIT
"""How models, trajectories and problems show themselves: in a line, and in notebooks."""
import base64
from typing import TYPE_CHECKING, Any, List

from ._record import columns, few_lines, table

if TYPE_CHECKING:
    from ._fettle import DesignProblem, Model, Trajectory


def names_of(names: List[str]) -> str:
    """Some of them."""
    told = ", ".join(names[:8])
    return told if len(names) <= 8 else f"{told} and {len(names) - 8} more"


def counted(count: int, what: str, plural: str = "") -> str:
    """"1 body", "2 bodies"."""
    return f"{count} {what if count == 1 else plural or what + 's'}"


def model_line(model: "Model") -> str:
    return few_lines(f"Model({counted(len(model), 'body', 'bodies')}: {names_of(model.body_names)})")


def model_html(model: "Model") -> str:
    rows: List[List[Any]] = [
        [name, kind, model.mass(b), len(model.vertices(b)), len(model.triangles(b))]
        for b, (name, kind) in enumerate(zip(model.body_names[:21], model.body_types[:21]))
    ]
    rows += [[]] * (len(model) - len(rows))
    picture = base64.b64encode(model._repr_png_()).decode()
    return (
        columns(f"fettle.Model, {counted(len(model), 'body', 'bodies')}", ["body", "type", "mass [kg]", "vertices", "triangles"], rows)
        + f"<img style='max-width:100%;width:600px' alt='the parts at the start' src='data:image/png;base64,{picture}'>"
    )


def trajectory_line(trajectory: "Trajectory") -> str:
    steps = f"{counted(len(trajectory), 'step')} of {trajectory.timestep:g} s" if len(trajectory) else "as assembled"
    return few_lines(f"Trajectory({counted(len(trajectory.body_names), 'body', 'bodies')}: {names_of(trajectory.body_names)}; {steps})")


def trajectory_html(trajectory: "Trajectory") -> str:
    times = trajectory.times
    rows = [
        ("bodies", names_of(trajectory.body_names)),
        ("steps", len(trajectory)),
        ("timestep", trajectory.timestep),
        *([("end", float(f"{times[-1]:.6g}"))] if len(times) else []),
    ]
    return table("Trajectory", rows)


def _parameters(problem: "DesignProblem") -> List[List[Any]]:
    rows = zip(problem.parameter_names, problem.values.tolist(), problem.lower.tolist(), problem.upper.tolist())
    return [list(row) for row in rows]


def problem_line(problem: "DesignProblem") -> str:
    return few_lines(f"DesignProblem({counted(len(problem.values), 'parameter')}: {names_of(problem.parameter_names)})")


def problem_html(problem: "DesignProblem") -> str:
    return columns("fettle.DesignProblem, SI", ["parameter", "value", "lower", "upper"], _parameters(problem))
