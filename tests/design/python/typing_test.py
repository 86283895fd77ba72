# SPDX-License-Identifier: MIT
"""The package as type checkers see it from outside: every public name is exported, and a user's program is checked by them."""
import ast
import inspect
import pathlib
import subprocess
import sys

import pytest

import fettle
from fettle import _fettle, design, errors, notebook, results, scene

PACKAGE = pathlib.Path(fettle.__file__).parent

PROGRAM = '''
import numpy as np

import fettle


class MeanHeight(fettle.Quantity):
    dimension = "length"

    def __init__(self, body: int) -> None:
        self.body = body

    def value(self, simulated: fettle.Simulated) -> float:
        return float(simulated.positions[:, self.body, 2].mean())

    def gradient(self, simulated: fettle.Simulated) -> fettle.QuantityGradient:
        positions = np.zeros_like(simulated.positions)
        positions[:, self.body, 2] = 1 / len(positions)
        return fettle.QuantityGradient(positions=positions)


def main(path: str) -> None:
    design = fettle.read_design(path).design
    design.objective.append(fettle.ObjectiveTerm("height", 1, 1e-3, MeanHeight(0)))
    problem = fettle.DesignProblem(design)
    model = problem.model_at(problem.values)
    simulation = fettle.simulate(model, steps=3)
    for pair in fettle.certify_clearance(model, simulation.trajectory, minimum=1e-4):
        print(pair.status, pair.lower + pair.upper)
'''
WITH_UNITS = '''
import pathlib

import fettle

scene = fettle.read_scene(pathlib.Path("a.scene.json"), mesh_dirs=[pathlib.Path(".")])
scene.timestep = "5ms"
scene.gravity = [0, 0, "-9.81m/s^2"]
twice = 2 * scene.timestep
scene.bodies.append(fettle.Body("cube", density="1.24g/cm^3", pose=fettle.Pose(position=["1mm", 0, 0])))
model = fettle.build_model(scene)
pairs = fettle.certify_clearance(model, pairs=[("cube", "table", "0.3mm")], minimum="0.2mm")
print(pairs.pair("cube", "table").lower + 1, pairs[0].status)
print(fettle.certify_ranges(model, minimum="0.2mm").pair("cube", "table").at)
problem = fettle.DesignProblem(fettle.Design(scene))
print(problem.value({"radius": "9mm"}), fettle.view(model).page)
fettle.explore(pathlib.Path("a.design.json"), pathlib.Path("a.jsonl"), sweep={"radius": ["9mm", 1e-2]})
'''
MISSPELT = '''
import fettle

scene = fettle.Scene()
scene.gravitty = [0, 0, -9.81]
print(scene.timestepp, fettle.Body().densty, fettle.Simulation().trajectry, fettle.PairRequest().minimun)
fettle.Scene(gravitty=[0, 0, -9.81])
'''
REVEALED = '''
reveal_type(fettle.Quantity())
reveal_type(fettle.read_design(""))
reveal_type(fettle.simulate)
fettle.no_such_name
'''


def test_every_public_name_is_exported():
    public = {name for name in dir(_fettle) if not name.startswith("_")}
    for module in (design, errors, notebook, results, scene):
        public |= {
            name
            for name, made in vars(module).items()
            if (inspect.isclass(made) or inspect.isfunction(made)) and made.__module__ == module.__name__ and not name.startswith("_")
        }
    assert not public - set(fettle.__all__)
    imported = [node for node in ast.walk(ast.parse((PACKAGE / "__init__.py").read_text())) if isinstance(node, ast.ImportFrom)]
    as_public = {alias.asname for node in imported for alias in node.names if alias.asname == alias.name and not alias.name.startswith("_")}
    assert set(fettle.__all__) == as_public - {"__version__"}


def mypy(tmp_path, text):
    pytest.importorskip("mypy")
    program = tmp_path / "program.py"
    program.write_text(text)
    words = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(PACKAGE.parent / "mypy_cache_outside"), str(program)]
    done = subprocess.run(words, cwd=PACKAGE.parent, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def test_numbers_with_units_names_and_paths_are_known(tmp_path):
    code, said = mypy(tmp_path, WITH_UNITS)
    assert code == 0, said


def test_misspelt_members_are_found(tmp_path):
    code, said = mypy(tmp_path, MISSPELT)
    assert code == 1
    for name in ("gravitty", "timestepp", "densty", "trajectry", "minimun"):
        assert f'has no attribute "{name}"' in said, said
    assert 'Unexpected keyword argument "gravitty"' in said and said.count("error:") == 6, said


def test_a_users_program_is_checked(tmp_path):
    code, said = mypy(tmp_path, PROGRAM)
    assert code == 0, said
    code, said = mypy(tmp_path, PROGRAM + REVEALED)
    assert code == 1
    assert 'Revealed type is "fettle.design.Quantity"' in said
    assert 'Revealed type is "fettle.design.DesignFile"' in said
    assert "-> fettle.results.Simulation" in said
    assert said.count("error:") == 1 and "no_such_name" in said
