#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the pictures of docs/concepts.md, of what the program says about examples/slider_crank (half a minute of one core):
draw.py FETTLE [FOLDER], from the root of the repository. Needs nothing but the standard library; the same program draws the same pictures.
Those in pixels: screenshots.py."""
import collections
import csv
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
DESIGN = "examples/slider_crank/slider_crank.design.json"
PICTURES = ("scene", "parts", "play", "margins", "contact", "convergence")
COLOURS = {}  # of parts, as `fettle draw` has them
INK, GREY, LINE = "#1d2024", "#5c626b", "#e3e0d9"  # as the report's page has them (design/report/web/src/style.css)
NEAREST, ALARM = "#1f56c4", "#c2182f"  # as design/exports/palette.hpp has them, and INK


def svg(width, height, parts):
    """A file that looks the same on light and dark pages."""
    return "\n".join([f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
                      'font-family="sans-serif" font-size="13">', f'<rect width="{width}" height="{height}" fill="white"/>', *parts, "</svg>", ""])


def label(x, y, text, anchor="start", colour=INK):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}">{text}</text>'


def line(points, colour, width=1.5, dash=""):
    path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    return f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="{width}"' + (f' stroke-dasharray="{dash}"' if dash else "") + "/>"


# Sections

def section(body, pose, height):
    """Closed outlines of a body in the plane z = height, lists of (x, y) in mm. A vertex in the plane counts as above it."""
    flat = body["mesh"]["vertices"]
    rotation, place = pose[:9], pose[9:]
    points = [[1000 * (sum(rotation[3 * row + k] * flat[i + k] for k in range(3)) + place[row]) for row in range(3)]
              for i in range(0, len(flat), 3)]
    follows, indices = {}, body["mesh"]["triangles"]
    for i in range(0, len(indices), 3):
        corners = indices[i:i + 3]
        cut = {}
        for a, b in zip(corners, corners[1:] + corners[:1]):
            if (points[a][2] < height) != (points[b][2] < height):
                cut["up" if points[a][2] < height else "down"] = (min(a, b), max(a, b))
        if cut:
            follows[cut["up"]] = cut["down"]
    outlines = []
    while follows:
        edge, loop = next(iter(follows)), []
        while edge in follows:
            a, b = (points[k] for k in edge)
            share = (height - a[2]) / (b[2] - a[2])
            loop.append((a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])))
            edge = follows.pop(edge)
        outlines.append(loop)
    return outlines


def drawn_section(start, height, place):
    """Of all bodies; `place` maps mm to pixels."""
    parts = []
    for body, pose in zip(start["bodies"], start["poses"]):
        path = "".join("M" + "L".join("{:.1f} {:.1f}".format(*place(x, y)) for x, y in loop) + "Z" for loop in section(body, pose, height))
        parts.append(f'<path d="{path}" fill="{COLOURS[body["name"]]}" fill-rule="evenodd" stroke="{INK}" stroke-width="0.7"/>')
    return parts


def window(left, bottom, scale, x, y):
    """From mm to pixels: (left, bottom) mm is at (x, y) pixels."""
    return lambda px, py: (x + scale * (px - left), y - scale * (py - bottom))


def play_picture(before, after, clearances):
    """The cut at the crank pin's middle, before and after, and how much play there is on a side."""
    parts = []
    for column, (start, clearance, name) in enumerate(((before, clearances[0], "as drawn"), (after, clearances[1], "tuned"))):
        x0 = 20 + 460 * column
        place = window(pin_centre(start) - 6.2, -6.2, 34, x0, 475)
        parts.append(f'<clipPath id="c{column}"><rect x="{x0}" y="53" width="{34 * 12.4:.0f}" height="422"/></clipPath>')
        parts.append(f'<g clip-path="url(#c{column})">' + "".join(drawn_section(start, 0.0, place)) + "</g>")
        (ax, ay), (bx, by) = (place(1000 * p[0], 1000 * p[1]) for p in (clearance["point_a"], clearance["point_b"]))
        parts.append(line([(ax, ay), (bx, by)], NEAREST, 3))
        lower, upper = math.floor(1e7 * clearance["lower"]) / 1e4, math.ceil(1e7 * clearance["upper"]) / 1e4
        bounds = f"proven: at least {lower:.4f} mm, at most {upper:.4f} mm"
        parts += [label(x0, 22, f"crank pin in the rod's bore, {name}"), label(x0, 42, bounds, colour=NEAREST)]
    return svg(920, 490, parts)


def pin_centre(start):
    """x of the middle of the crank's outline in the plane z = 0: its pin."""
    body = next(i for i, b in enumerate(start["bodies"]) if b["name"] == "crank")
    xs = [x for loop in section(start["bodies"][body], start["poses"][body], 0.0) for x, _ in loop]
    return (min(xs) + max(xs)) / 2


def parts_picture(start):
    place = window(5, -17.5, 12, 20, 430)
    names = {"block": (62, 12.7), "crank": (13.5, -0.4), "rod": (34, -0.4), "piston": (71, -0.4)}
    parts = drawn_section(start, 0.0, place)
    parts += [label(*place(x, y), name, "middle") for name, (x, y) in names.items()]
    return svg(920, 440, parts)


# Curves

class Axes:
    """A frame with ticks; place() maps values to pixels."""

    def __init__(self, box, x, y, names):
        (self.x0, self.y0, self.width, self.height), self.x, self.y = box, x, y
        bottom = self.y0 + self.height
        self.parts = [f'<rect x="{self.x0}" y="{self.y0}" width="{self.width}" height="{self.height}" fill="none" stroke="{GREY}"/>',
                      label(self.x0 + self.width, bottom + 34, names[0], "end"), label(self.x0, self.y0 - 8, names[1])]
        for value in x[2]:
            self.parts.append(label(self.place(value, y[0])[0], bottom + 17, f"{value:g}", "middle", GREY))
        for value in y[2]:
            px, py = self.place(x[0], value)
            self.parts += [label(px - 6, py + 4, f"{value:g}", "end", GREY), line([(px, py), (px + self.width, py)], LINE, 1)]

    def place(self, x, y):
        return (self.x0 + self.width * (x - self.x[0]) / (self.x[1] - self.x[0]),
                self.y0 + self.height * (1 - (y - self.y[0]) / (self.y[1] - self.y[0])))

    def level(self, value, text, colour=ALARM, below=0):
        (x, y), (end, _) = self.place(self.x[0], value), self.place(self.x[1], value)
        self.parts += [line([(x, y), (end, y)], colour, 1.2, "6 4"), label(end - 4, y - 5 + below, text, "end", colour)]


def margin_axes(rows, pair, box, top, ticks, title):
    """Certified bounds over time: the least distance in each stretch of the path lies within the band."""
    axes = Axes(box, (0, 1.025, (0, 0.2, 0.4, 0.6, 0.8, 1)), (0, top, ticks), ("time [s]", title))
    for row in (row for row in rows[pair] if row[3] <= top):
        (x0, low), (x1, high) = axes.place(row[0], row[2]), axes.place(row[1], row[3])
        axes.parts.append(f'<rect x="{x0:.1f}" y="{high - 0.75:.1f}" width="{x1 - x0:.1f}" height="{low - high + 1.5:.1f}" fill="{INK}"/>')
    return axes


def margins_picture(rows):
    one = margin_axes(rows, ("crank", "piston"), (60, 40, 380, 260), 6, (0, 1, 2, 3, 4, 5, 6), "crank and piston, nearest [mm]")
    two = margin_axes(rows, ("block", "rod"), (520, 40, 380, 260), 6, (0, 1, 2, 3, 4, 5, 6), "rod and block, nearest [mm]")
    for axes in (one, two):
        axes.level(1, "required: 1 mm", below=20)
    return svg(920, 345, one.parts + two.parts)


def contact_picture(rows):
    axes = margin_axes(rows, ("block", "crank"), (60, 40, 840, 220), 0.1, (0, 0.02, 0.04, 0.06, 0.08, 0.1), "crank's journal and block's bearing, nearest [mm]")
    axes.level(0.08, "contact distance: pushes below", NEAREST)
    axes.level(0.0005, "touching", ALARM)
    return svg(920, 305, axes.parts)


def convergence_picture(history, own):
    """`own`: the first evaluation of the design's own model; those before are of smoother ones."""
    last = len(history)
    axes = Axes((60, 40, 840, 240), (1, last, range(1, last + 1, 2)), (15, 26, (15, 17, 19, 21, 23, 25)),
                ("evaluation: a whole turn simulated, and its gradient", "objective; filled: every requirement is met"))
    for entry in history:
        x, y = axes.place(entry["evaluation"], entry["objective"])
        fill = "#2a7f3f" if entry["met"] else "white"
        axes.parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="5" fill="{fill}" stroke="#2a7f3f" stroke-width="1.5"/>')
    x = axes.place(own - 0.5, 15)[0]
    axes.parts += [line([(x, 40), (x, 280)], GREY, 1.2, "6 4"), label(x - 6, 56, "smoother models: wider contact", "end", GREY),
                   label(x + 6, 56, "the design's own", colour=GREY)]
    return svg(920, 325, axes.parts)


def margins(path):
    """By pair: (start [s], end [s], lower [mm], upper [mm]) of each stretch."""
    rows = collections.defaultdict(list)
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            rows[row["a"], row["b"]].append([float(row[key]) for key in ("time_start[s]", "time_end[s]", "lower[mm]", "upper[mm]")])
    return rows


def evaluations(path, limits):
    """Objective of each evaluation, and whether the values meet the constraints' bounds."""
    found = []
    for text in path.read_text().splitlines()[1:]:
        entry = json.loads(text)
        if entry.get("usable"):
            met = all(limit["lower"] <= value <= limit["upper"] for value, limit in zip(entry["constraints"], limits))
            found.append({"evaluation": entry["evaluation"], "objective": entry["objective"], "met": met})
    return found


def main(program, place=HERE):
    place = pathlib.Path(place)

    def run(*arguments):
        return json.loads(subprocess.run([program, "--json", "--quiet", *arguments], cwd=HERE.parent.parent, capture_output=True, text=True, check=False).stdout)

    def first_line(path):
        with open(path) as file:
            return json.loads(file.readline())

    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder)
        run("draw", DESIGN, "--out", str(place / "scene.svg"), "--size", "920x560", "--plain", "--title", "slider-crank")
        COLOURS.update({name: colour for colour, name in re.findall(r'fill="(#\w{6})"/>\n<text [^>]*>([^<]+)', (place / "scene.svg").read_text())})
        run("simulate", DESIGN, "--steps", "1", "--out", folder + "/before")
        tuned = run("optimise", DESIGN, "--out", folder + "/after")
        after = folder + "/after/trajectory.json"
        run("clearance", after, "--pairs", "crank:piston,block:rod,block:crank", "--csv", folder + "/margins.csv")
        clearances = [run("clearance", file, "--pairs", "crank:rod")["pairs"][0] for file in (DESIGN, folder + "/after/design.final.json")]
        starts = [first_line(out / which / "trajectory.json") for which in ("before", "after")]
        rows = margins(out / "margins.csv")
        own = tuned["evaluations"] - tuned["stages"][-1]["evaluations"] + 1
        limits = [{"lower": 0.0003, "upper": 1}] * 4 + [{"lower": 0.001, "upper": 1}] * 2 + [{"lower": 0.02995, "upper": 0.03005}]
        pictures = {"parts": parts_picture(starts[0]), "play": play_picture(*starts, clearances), "margins": margins_picture(rows),
                    "contact": contact_picture(rows), "convergence": convergence_picture(evaluations(out / "after/history.jsonl", limits), own)}
    for name, text in pictures.items():
        (place / f"{name}.svg").write_text(text)
        print(f"{name}.svg: {len(text)} bytes, tuned: {tuned['status']}")


if __name__ == "__main__":
    main(*sys.argv[1:])
