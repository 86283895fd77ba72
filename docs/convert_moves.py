#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Rewrites design files whose parameters have `moves` (version 0.1): the formulas that they stand for go into the design's `set`.

    docs/convert_moves.py FILE.design.json ...

A file is rewritten in place; what cannot be converted is reported and left. Layout is kept but for the lists of moves.
"""
import json
import pathlib
import re
import sys

UNITS = {"position": "mm", "point": "mm"}
LENGTHS = ("dimension", "position", "point", "point_a", "point_b", "rest", "pitch", "radius", "dmin")
ANGLES = ("turn",)


def number(text):
    return repr(text) if isinstance(text, float) else str(text)


def quoted(name):
    return name if re.fullmatch(r"[A-Za-z_\x80-\U0010ffff][\w.]*", name) else f"'{name}'"


def times(factor, text):
    if factor == 1:
        return text
    return f"-{text}" if factor == -1 else f"{number(factor)} * {text}"


def place_of(move, scene):
    """The pointer, and what a vector's coefficients stand in."""
    def escaped(name):
        return str(name).replace("~", "~0").replace("/", "~1")
    skip = {"scale", "offset"}
    if "gravity" in move:
        return "/gravity", move["gravity"]
    if "dmin" in move:
        return "/contact/dmin", True
    if "mu" in move:
        if "body" in move:
            return f"/bodies/{escaped(move['body'])}/mu", True
        if "material" in move:
            return f"/materials/{escaped(move['material'])}/mu", True
        if "materials" in move:
            pairs = scene.get("friction", {}).get("pairs", [])
            index = next(k for k, pair in enumerate(pairs) if {pair["a"], pair["b"]} == set(move["materials"]))
            return f"/friction/pairs/{index}/mu", True
        return "/friction/mu", True
    if "motor" in move and "rate" in move:
        return f"/bodies/{escaped(move['motor'])}/prescribed/{move['rate']}/rate", True
    for subject, listing in (("body", "bodies"), ("joint", "joints"), ("spring", "springs"), ("damper", "dampers"), ("motor", "motors"),
                             ("load", "loads")):
        if subject not in move:
            continue
        base = f"/{listing}/{escaped(move[subject])}"
        key = next(k for k in move if k not in skip and k != subject)
        if key == "dimension":
            return f"{base}/shape/dimensions/{escaped(move[key])}", True
        if key == "velocity":
            return f"{base}/linear_velocity", move[key]
        if key in ("lower_limit", "upper_limit"):
            return f"{base}/limits/{0 if key == 'lower_limit' else 1}", True
        if key == "value":
            entry = next(m for m in scene["motors"] if m["name"] == move["motor"])
            curve = next(k for k in ("angle", "travel", "torque", "force") if k in entry)
            return f"{base}/{curve}/values/{move[key]}", True
        if key == "turn":
            raise ValueError("a `turn`: write the angle in the body's `rotation`")
        return f"{base}/{key}", move[key]
    raise ValueError(f"what is moved by {move}?")


def terms_of(parameter, move, scene):
    """(pointer, factor times the parameter, offset) for each number."""
    place, vector = place_of(move, scene)
    scale, offset = move.get("scale", 1), move.get("offset", 0)
    if not isinstance(vector, list):
        yield place, scale, offset
        return
    offsets = offset if isinstance(offset, list) else [offset, offset, offset]
    for k, coefficient in enumerate(vector):
        if coefficient:
            yield f"{place}/{k}", coefficient * scale, offsets[k]


def unit_of(pointer, parameter):
    """A pure number that moves a quantity counts in the file's unit of it."""
    if parameter.get("unit") != "1" or pointer.endswith("/mu") or "/axis" in pointer or pointer.endswith(("ratio", "damping")):
        return ""
    return " * 1 unit"


def formulas(design, scene):
    out = {}
    for parameter in design["parameters"]:
        for move in parameter.get("moves", []):
            for pointer, factor, offset in terms_of(parameter, move, scene):
                terms, offsets = out.setdefault(pointer, ([], []))
                if unit_of(pointer, parameter):
                    raise ValueError(f"parameter `{parameter['name']}` is a pure number that moves {pointer}: multiply it by a unit")
                terms.append(times(factor, quoted(parameter["name"])))
                if offset:
                    offsets.append(number(offset))
    return {pointer: "= " + " + ".join(terms + offsets).replace("+ -", "- ") for pointer, (terms, offsets) in out.items()}


def whole_vectors(found, scene):
    """Numbers of vectors that the scene's file leaves to their defaults are set as whole vectors."""
    out = {}
    for pointer, formula in found.items():
        words = pointer.split("/")[1:]
        at, missing = scene, None
        for depth, word in enumerate(words):
            if isinstance(at, list):
                at = next((e for e in at if isinstance(e, dict) and e.get("name") == word.replace("~1", "/")), None) if not word.isdigit() \
                    else at[int(word)]
            elif isinstance(at, dict) and word not in at and depth + 1 < len(words):
                missing = depth
                break
            elif isinstance(at, dict):
                at = at.get(word)
        if missing is None or missing + 2 != len(words):
            out[pointer] = formula
            continue
        out.setdefault("/" + "/".join(words[:-1]), [0, 0, 0])[int(words[-1])] = formula
    return out


def without_moves(text):
    """The text without the members `moves`."""
    while True:
        match = re.search(r',\s*"moves"\s*:\s*\[', text)
        if not match:
            return text
        depth, end = 1, match.end()
        while depth:
            depth += {"[": 1, "]": -1}.get(text[end], 0)
            end += 1
        rest = text[end:]
        text = text[:match.start()] + (re.sub(r"^\s*}", " }", rest) if re.match(r"^\s*}", rest) else rest)


def with_set(text, members):
    """After `parameters`."""
    match = re.search(r'"parameters"\s*:\s*\[', text)
    depth, end = 1, match.end()
    while depth:
        depth += {"[": 1, "]": -1}.get(text[end], 0)
        end += 1
    lines = ",\n".join(f"    {json.dumps(pointer, ensure_ascii=False)}: {json.dumps(value, ensure_ascii=False)}" for pointer, value in members.items())
    return text[:end] + ',\n  "set": {\n' + lines + "\n  }" + text[end:]


def one_line_parameters(text):
    """A parameter of three short lines becomes one."""
    return re.sub(r"\{\s*\n\s*(\"name\":[^\n{}]*)\n?\s*\}", lambda m: "{ " + m.group(1).strip() + " }", text)


def converted(text, scene):
    design = json.loads(text)
    if not any("moves" in parameter for parameter in design["parameters"]):
        return text
    return one_line_parameters(with_set(without_moves(text), whole_vectors(formulas(design, scene), scene)))


def main(names):
    faults = 0
    for name in names:
        path = pathlib.Path(name)
        try:
            text = path.read_text()
            scene = json.loads((path.parent / json.loads(text)["scene"]).read_text())
            path.write_text(converted(text, scene))
        except (OSError, ValueError, KeyError, StopIteration) as fault:
            print(f"{name}: {fault}", file=sys.stderr)
            faults += 1
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
