# SPDX-License-Identifier: MIT
"""The README's Python program runs."""
import re

from conftest import ROOT


def test_the_readmes_program(capsys, monkeypatch):
    monkeypatch.chdir(ROOT)
    (program,) = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)
    exec(compile(program, "README.md", "exec"), {"__name__": "readme"})  # pylint: disable=exec-used
    assert "array([" in capsys.readouterr().out
