# SPDX-License-Identifier: MIT
"""A factor of 1000 in a body's lengths does not pass in silence."""
import warnings

import pytest

import fettle
from conftest import box


def scene_with_rod(length):
    return fettle.Scene(bodies=[fettle.Body("rod", mesh=box(length, 0.2 * length, 0.1 * length, "rod"), density=1240)])


def test_millimetres_taken_for_metres_are_warned_of():
    with pytest.warns(UserWarning, match="body `rod`: its size is 58 m .* hardly meant"):
        fettle.build_model(scene_with_rod(58.0))
    for length, size in ((10.0, "10 m"), (0.058e-3, "58 um")):
        with pytest.warns(UserWarning, match=f"body `rod`: its size is {size} .* hardly meant"):
            fettle.build_model(scene_with_rod(length))
    scene = scene_with_rod(0.058)
    scene.gravity = [0, 0, -9810]
    with pytest.warns(UserWarning, match="scene/gravity: gravity is 9810 m/s.2, which is hardly meant"):
        fettle.build_model(scene)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        fettle.build_model(scene_with_rod(0.058))
