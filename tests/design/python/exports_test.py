# SPDX-License-Identifier: MIT
"""Models out, pictures."""
import struct

import pytest

import fettle
from simulation_test import falling_cube


def png_size(picture):
    assert picture[:8] == b"\x89PNG\r\n\x1a\n"
    return struct.unpack(">II", picture[16:24])


def test_parts_and_their_motion_as_files(tmp_path):
    model = falling_cube()
    trajectory = fettle.simulate(model).trajectory
    (moving,) = fettle.export_files(str(tmp_path), "glb", model, trajectory, stem="fall")
    assert moving == str(tmp_path / "fall.glb")
    still = fettle.export_files(str(tmp_path), "glb", model, stem="start")
    with open(moving, "rb") as of_motion, open(still[0], "rb") as of_start:
        assert b'"animations"' in of_motion.read()
        assert b'"animations"' not in of_start.read()
    parts = fettle.export_files(str(tmp_path), "stl", model, arrangement="parts")
    assert sorted(parts) == [str(tmp_path / "cube.stl"), str(tmp_path / "table.stl")]
    cube = fettle.read_mesh(parts[1], unit=1e-3)
    assert cube.vertices.max() - cube.vertices.min() == pytest.approx(0.01, abs=1e-8)
    frames = fettle.export_files(str(tmp_path), "vtu", model, trajectory, every=5)
    assert len(frames) == 4  # steps 0, 5, 10, and the collection
    with pytest.raises(fettle.Error, match="none of glb"):
        fettle.export_files(str(tmp_path), "step", model)


def test_pictures(tmp_path):
    model = falling_cube(height=0.02)
    trajectory = fettle.simulate(model).trajectory
    first, last = (fettle.draw_picture(model, trajectory, t=t, view="front", size=(320, 240)) for t in (0, -1))
    assert png_size(first) == (320, 240)
    assert first != last
    assert fettle.draw_picture(model, view="front", size=(320, 240)) == first
    assert b"<svg" in fettle.draw_picture(model, svg=True, title="a cube")
    assert png_size(model._repr_png_()) == (800, 600)
    with pytest.raises(fettle.Error, match="view"):
        fettle.draw_picture(model, view="isometrical")
    with pytest.raises(IndexError):
        fettle.draw_picture(model, trajectory, t=99)
