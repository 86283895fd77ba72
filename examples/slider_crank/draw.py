#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws a trajectory's parts at one step, static ones cut open: draw.py TRAJECTORY.json PICTURE.png [STEP]. Needs python3-numpy.
The README's picture: optimise the design, then draw.py OUT/trajectory.json slider_crank.png 35. The parts' colours are those of OUT/motion.glb."""
import json
import pathlib
import struct
import sys
import zlib

import numpy as np

WIDTH, HEIGHT, SAMPLES = 960, 460, 2


def colours(animation):
    """By the bodies' names, sRGB, of a GLB file; it has them linear."""
    data = animation.read_bytes()
    scene = json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])
    found = {}
    for node in scene["nodes"]:
        if "mesh" in node:
            material = scene["meshes"][node["mesh"]]["primitives"][0]["material"]
            linear = np.array(scene["materials"][material]["pbrMetallicRoughness"]["baseColorFactor"][:3])
            found[node["name"]] = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return found


def camera():
    """Rows: right, up, towards the viewer."""
    back = np.array([-0.30, -0.62, 0.72])
    back /= np.linalg.norm(back)
    right = np.cross([0, 0, 1], back)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(back, right), back])


def world_triangles(body, pose):
    """n x 3 x 3. A pose is nine numbers of a rotation by rows, then a position; vertices are relative to the reference point."""
    vertices = np.array(body["mesh"]["vertices"]).reshape(-1, 3)
    moved = vertices @ np.array(pose[:9]).reshape(3, 3).T + np.array(pose[9:])
    return moved[np.array(body["mesh"]["triangles"]).reshape(-1, 3)]


def rasterise(triangle, colour, image, depth):
    """One triangle in pixel coordinates (x, y, towards the viewer) into the image, by its depth."""
    low = np.maximum(np.floor(triangle[:, :2].min(axis=0)).astype(int), 0)
    high = np.minimum(np.ceil(triangle[:, :2].max(axis=0)).astype(int) + 1, [image.shape[1], image.shape[0]])
    if (high <= low).any():
        return
    x, y = np.meshgrid(np.arange(low[0], high[0]) + 0.5, np.arange(low[1], high[1]) + 0.5)
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = triangle
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    if area == 0:
        return
    v = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / area
    w = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / area
    z = az + v * (bz - az) + w * (cz - az)
    rows, columns = slice(low[1], high[1]), slice(low[0], high[0])
    seen = (v >= 0) & (w >= 0) & (v + w <= 1) & (z > depth[rows, columns])
    depth[rows, columns][seen] = z[seen]
    image[rows, columns][seen] = colour


def write_png(path, image):
    """8-bit RGB, h x w x 3 in [0, 1]."""
    pixels = (np.clip(image, 0, 1) * 255 + 0.5).astype(np.uint8)
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", pixels.shape[1], pixels.shape[0], 8, 2, 0, 0, 0)
    with open(path, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def main():
    with open(sys.argv[1]) as file:
        header, *steps = (json.loads(line) for line in file)  # the bodies and their start, then a line for each step
    poses = [line["poses"] for line in (header, *steps) if "poses" in line]
    step = int(sys.argv[3]) if len(sys.argv) > 3 else 0
    view, colour_of = camera(), colours(pathlib.Path(sys.argv[1]).with_name("motion.glb"))
    parts = [(body, world_triangles(body, pose) @ view.T) for body, pose in zip(header["bodies"], poses[step])]
    points = np.concatenate([triangles.reshape(-1, 3) for _, triangles in parts])
    low, high = points.min(axis=0), points.max(axis=0)
    size = np.array([WIDTH, HEIGHT]) * SAMPLES
    scale = 0.96 * (size / (high - low)[:2]).min()
    image, depth = np.ones((size[1], size[0], 3)), np.full((size[1], size[0]), -np.inf)
    light = np.array([-0.35, 0.55, 0.75]) / np.linalg.norm([0.35, 0.55, 0.75])
    hidden = None
    for body, triangles in sorted(parts, key=lambda part: part[0]["type"] != "static"):
        if body["type"] != "static" and hidden is None:  # moving parts show through static ones
            hidden = image.copy(), depth.copy()
            depth[:] = -np.inf
        for triangle in triangles:
            normal = np.cross(triangle[1] - triangle[0], triangle[2] - triangle[0])
            normal /= np.linalg.norm(normal)
            if body["type"] == "static":
                if normal[2] > 0:
                    continue  # what faces the viewer is cut away
                normal = -normal
            shade = 0.5 + 0.5 * max(0.0, normal @ light)
            pixel = (triangle - (low + high) / 2) * scale
            pixel[:, 0] += size[0] / 2
            pixel[:, 1] = size[1] / 2 - pixel[:, 1]
            rasterise(pixel, colour_of[body["name"]] * shade, image, depth)
    behind = depth < hidden[1]
    image[behind] = 0.6 * image[behind] + 0.4 * hidden[0][behind]
    write_png(sys.argv[2], image.reshape(HEIGHT, SAMPLES, WIDTH, SAMPLES, 3).mean(axis=(1, 3)))


main()
