# SPDX-License-Identifier: MIT
"""Parts and their motion in three dimensions, in a notebook: the report's page in a frame of its own, which needs no network.

    fettle.view(model, simulation.trajectory)
"""
import html
import os
import pathlib
from typing import Optional, Union

from . import _fettle


class View:
    """A page that a notebook shows. `page` is its HTML, whole."""

    def __init__(self, page: str, height: int = 640):
        self.page = page
        self.height = height

    def save(self, path: "Union[str, os.PathLike[str]]") -> str:
        """Writes the page for any browser; its path."""
        try:
            pathlib.Path(path).write_text(self.page, encoding="utf-8")
        except OSError as error:  # of a full disk it names no file
            raise OSError(error.errno, error.strerror, os.fspath(path)) from None
        return os.fspath(path)

    def __repr__(self) -> str:
        return f"View({len(self.page) // 1024} kB; a notebook shows it, save(path) writes it for a browser)"

    def _repr_html_(self) -> str:
        # sandbox: the page runs its own script, and has nothing of the notebook's.
        return (
            f'<iframe sandbox="allow-scripts" style="width:100%;height:{self.height}px;border:0" title="fettle: parts and their motion" '
            f'srcdoc="{html.escape(self.page)}"></iframe>'
        )


def view(
    model: _fettle.Model, trajectory: Optional[_fettle.Trajectory] = None, *, title: str = "", height: int = 640
) -> View:
    """Parts, and with a trajectory their motion, to turn, cut and play in a notebook. height: in pixels."""
    return View(_fettle.view_page(model, trajectory, title), height)
