#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the pictures of the gallery (docs/gallery.md): each mechanism as its scene has it, examples/NAME/before.png, and as it was tuned,
examples/NAME/after.png, with the nearest points marked: gallery.py FETTLE [FOLDER [NAME ...]], from the root of the repository. In FOLDER the
pictures are called as in the repository."""
import pathlib
import subprocess
import sys

VIEWS = {"geneva": "top", "gear_pair": "top", "cam_follower": "top", "ratchet": "top", "detent_hinge": "top", "lock_box": "iso",
         "toggle_clamp": "top", "cabinet_latch": "top",
         "planetary": "top", "quick_return": "top", "scotch_yoke": "top", "stl_housing": "top", "slider_crank": "top", "four_bar": "front"}
PICTURES = [f"examples/{name}/{when}.png" for name in VIEWS for when in ("before", "after")]


def main(program, folder=".", names=VIEWS):
    for name in names:
        for when, file in (("before", f"{name}.scene.json"), ("after", "tuned.design.json")):
            out = pathlib.Path(folder) / f"examples/{name}/{when}.png"
            out.parent.mkdir(parents=True, exist_ok=True)
            subprocess.run([program, "draw", f"examples/{name}/{file}", "--view", VIEWS[name], "--size", "480x320" if name == "lock_box" else "640x420", "--title", when, "--out", out],
                           check=True, capture_output=True)


if __name__ == "__main__":
    main(sys.argv[1], *sys.argv[2:3], *([sys.argv[3:]] if sys.argv[3:] else []))
