# SPDX-License-Identifier: MIT
"""Parts from functions and programs that make meshes: derivatives from rebuilt ones; the hinge of OpenSCAD."""
import json
import pickle
import shutil

import numpy as np
import pytest

import fettle
from conftest import EXAMPLES, Frustum, MeanHeight, tilted_plate

HINGE = EXAMPLES / "openscad_hinge"


def frustum_mesh(values):
    if min(values.values()) <= 0:
        raise ValueError("a frustum's dimensions are above 0")
    return Frustum(1, 1, 1).at(values)[0]


def rounded_frustum(values):
    mesh = frustum_mesh(values)
    mesh.vertices = np.array([[float(f"{1e3 * x:.6g}") * 1e-3 for x in row] for row in mesh.vertices])
    return mesh


DRAWN = {"foot": 8e-3, "top": 5e-3, "height": 8e-3}


def test_a_function_of_meshes_has_the_exact_shapes_derivative():
    exact = Frustum(**DRAWN).at(DRAWN)[1]
    for function, limit in ((frustum_mesh, 1e-9), (rounded_frustum, 2e-4)):
        mesh, found = fettle.shape_at(fettle.MeshShape(function, DRAWN))
        assert mesh.vertices.shape == (8, 3)
        for name in DRAWN:
            assert np.abs(found[name] - exact[name]).max() < limit, name
    assert len(fettle.shape_remarks(fettle.MeshShape(rounded_frustum, DRAWN))) == 3
    assert not fettle.shape_remarks(Frustum(**DRAWN))


def test_a_design_with_a_function_of_meshes():
    exact = fettle.DesignProblem(tilted_plate())
    made = fettle.DesignProblem(tilted_plate(shape=fettle.MeshShape(frustum_mesh, DRAWN)))
    value, gradient = made.value_and_gradient(made.values)
    expected, expected_gradient = exact.value_and_gradient(exact.values)
    assert value == pytest.approx(expected, rel=1e-9)
    assert gradient == pytest.approx(expected_gradient, rel=1e-6)
    wide = tilted_plate(shape=fettle.MeshShape(frustum_mesh, DRAWN))
    wide.parameters[1].lower = -1e-3
    made = fettle.DesignProblem(wide)
    p = made.values
    p[1] = -1e-3
    assert "above 0" in made.evaluate(p).reason


def test_a_function_is_called_for_the_dimensions_that_a_design_moves():
    called = []

    def counted(values):
        called.append(values)
        return frustum_mesh(values)

    design = tilted_plate(shape=fettle.MeshShape(counted, DRAWN))
    assert len(called) == 1  # its mesh as drawn
    design.numbers = [number for number in design.numbers if not number.place.endswith(("/top", "/foot"))]
    problem = fettle.DesignProblem(design)
    assert problem.evaluate(problem.values).usable
    assert len(called) == 1 + 1 + 4


def test_a_mesh_shape_pickles():
    shape = fettle.MeshShape(frustum_mesh, DRAWN)
    assert pickle.loads(pickle.dumps(shape)) == shape


def test_programs_run_only_when_they_are_allowed():
    with pytest.raises(fettle.Error, match="--allow-programs"):
        fettle.read_scene(str(HINGE / "openscad_hinge.scene.json"))
    with pytest.raises(fettle.Error, match="--allow-programs"):
        fettle.read_design(str(HINGE / "openscad_hinge.design.json"))


@pytest.mark.programs
@pytest.mark.skipif(shutil.which("openscad") is None, reason="Debian's openscad is not installed")
def test_the_hinge_of_openscad_is_tuned_under_certified_clearance(tmp_path):
    path = str(HINGE / "openscad_hinge.design.json")
    file = fettle.read_design(path, allow_programs=True)
    assert sum("vertex by vertex" in warning or "normal velocity" in warning for warning in file.warnings) == 3
    assert isinstance(file.design.shapes[0], fettle.ProgramShape)
    assert pickle.loads(pickle.dumps(file)) == file
    outcome = fettle.optimise_file(path, str(tmp_path), allow_programs=True)
    assert outcome.report.feasible, outcome.limits
    (pair,) = [m.clearance for m in outcome.final.constraints if m.clearance]
    assert pair.lower >= 0.3e-3
    assert outcome.final.objective < outcome.objective_start or outcome.report.status == "optimal"
    assert json.loads((tmp_path / "result.json").read_text())["constraint_violation_start"] > 0
    # The design before is made anew for the report, by the programs.
    assert (tmp_path / "trajectory.start.json").exists() and (tmp_path / "report.html").exists()
    with pytest.raises(fettle.Error, match="--allow-programs"):
        fettle.write_report(str(tmp_path))
