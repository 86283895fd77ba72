# SPDX-License-Identifier: MIT
"""The example programs run, and end as they say."""
import pathlib
import subprocess
import sys

import pytest

from conftest import EXAMPLES

PROGRAMS = EXAMPLES / "programs"


def run(name, *arguments):
    program = [sys.executable, str(PROGRAMS / name), *map(str, arguments)]
    done = subprocess.run(program, capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_programs_are_short_and_there_in_both_languages():
    numbered = sorted(PROGRAMS.glob("[0-9]_*"))
    assert [p.name for p in numbered] == [f"{n}{end}" for n in ("1_simulate", "2_certify", "3_differentiate", "4_optimise") for end in (".cpp", ".py")]
    for program in numbered:
        assert len(program.read_text().splitlines()) <= 60, program.name


def test_simulate():
    assert "ok: 40 steps, 0.01" in run("1_simulate.py")


def test_certify():
    assert "clear: at least 1.1" in run("2_certify.py")


def test_differentiate():
    assert "by differences" in run("3_differentiate.py")


def test_optimise():
    assert "optimal: foot 8.08" in run("4_optimise.py")


def test_sweep(tmp_path):
    pytest.importorskip("matplotlib")
    said = run("sweep.py", tmp_path / "sweep.png", 3)
    assert "9 of 9 designs" in said
    assert (tmp_path / "sweep.png").read_bytes().startswith(b"\x89PNG")


def test_scipy():
    pytest.importorskip("scipy")
    assert "to spare" in run("scipy_optimise.py")


def test_an_openmdao_component():
    said = run("openmdao_component.py", EXAMPLES / "slider_crank" / "slider_crank.design.json")
    assert "10 constraints" in said
    assert run("openmdao_component.py") == said
