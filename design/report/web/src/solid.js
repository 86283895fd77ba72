// SPDX-License-Identifier: MIT
// From a mesh to what is drawn: triangles with normals that follow shallow edges and break at sharp ones, and lines along the sharp ones.
import * as THREE from "three";

const sharp = Math.cos(0.6);  // as `fettle draw` has it: of a polygon of 12 sides no edge

const directions = [];
for (let x = -1; x <= 1; ++x) for (let y = -1; y <= 1; ++y) for (let z = -1; z <= 1; ++z) if (x || y || z) directions.push([x, y, z]);

// Vertices that are farthest in some direction: enough to tell how large it looks.
function outermost(vertices) {
  const found = new Set();
  for (const [x, y, z] of directions) {
    let best = 0, most = -Infinity;
    for (let v = 0; v < vertices.length; v += 3) {
      const reach = x * vertices[v] + y * vertices[v + 1] + z * vertices[v + 2];
      if (reach > most) [best, most] = [v, reach];
    }
    found.add(best);
  }
  return [...found].map((v) => new THREE.Vector3(vertices[v], vertices[v + 1], vertices[v + 2]));
}

function faceNormals(vertices, triangles) {
  const count = triangles.length / 3, normals = new Float32Array(3 * count);
  for (let t = 0; t < count; ++t) {
    const a = 3 * triangles[3 * t], b = 3 * triangles[3 * t + 1], c = 3 * triangles[3 * t + 2];
    const ux = vertices[b] - vertices[a], uy = vertices[b + 1] - vertices[a + 1], uz = vertices[b + 2] - vertices[a + 2];
    const vx = vertices[c] - vertices[a], vy = vertices[c + 1] - vertices[a + 1], vz = vertices[c + 2] - vertices[a + 2];
    normals[3 * t] = uy * vz - uz * vy;  // its length is twice the area: a weight
    normals[3 * t + 1] = uz * vx - ux * vz;
    normals[3 * t + 2] = ux * vy - uy * vx;
  }
  return normals;
}

// Of each vertex the corners there: corners[first[v] .. first[v + 1]).
function cornersByVertex(count, triangles) {
  const first = new Uint32Array(count + 1), corners = new Uint32Array(triangles.length);
  for (const v of triangles) ++first[v + 1];
  for (let v = 0; v < count; ++v) first[v + 1] += first[v];
  const next = first.slice();
  for (let c = 0; c < triangles.length; ++c) corners[next[triangles[c]]++] = c;
  return { first, corners };
}

// Vertices with normals, and triangles of them: a vertex is there once for each normal that its corners have.
function smoothed(vertices, triangles, faces) {
  const count = vertices.length / 3, { first, corners } = cornersByVertex(count, triangles);
  const lengths = new Float32Array(faces.length / 3);
  for (let t = 0; t < lengths.length; ++t) lengths[t] = Math.hypot(faces[3 * t], faces[3 * t + 1], faces[3 * t + 2]) || 1;
  const positions = [], normals = [], index = new Uint32Array(triangles.length);
  for (let v = 0; v < count; ++v) {
    const begin = normals.length / 3;
    for (let k = first[v]; k < first[v + 1]; ++k) {
      const t = (corners[k] / 3) | 0, x = faces[3 * t], y = faces[3 * t + 1], z = faces[3 * t + 2];
      let nx = 0, ny = 0, nz = 0;
      for (let l = first[v]; l < first[v + 1]; ++l) {
        const o = (corners[l] / 3) | 0, ox = faces[3 * o], oy = faces[3 * o + 1], oz = faces[3 * o + 2];
        if (o !== t && x * ox + y * oy + z * oz < sharp * lengths[t] * lengths[o]) continue;
        nx += ox;
        ny += oy;
        nz += oz;
      }
      const length = Math.hypot(nx, ny, nz) || 1;
      nx /= length;
      ny /= length;
      nz /= length;
      let at = begin;
      while (at < normals.length / 3 && nx * normals[3 * at] + ny * normals[3 * at + 1] + nz * normals[3 * at + 2] < 0.9999) ++at;
      if (at === normals.length / 3) {
        normals.push(nx, ny, nz);
        positions.push(vertices[3 * v], vertices[3 * v + 1], vertices[3 * v + 2]);
      }
      index[corners[k]] = at;
    }
  }
  return { positions: new Float32Array(positions), normals: new Float32Array(normals), index };
}

function sharpEdges(vertices, triangles, faces) {
  const count = vertices.length / 3, seen = new Map(), ends = [];
  const add = (a, b) => ends.push(vertices[3 * a], vertices[3 * a + 1], vertices[3 * a + 2], vertices[3 * b], vertices[3 * b + 1], vertices[3 * b + 2]);
  for (let c = 0; c < triangles.length; ++c) {
    const t = (c / 3) | 0, a = triangles[c], b = triangles[c % 3 === 2 ? c - 2 : c + 1];
    const key = a < b ? a * count + b : b * count + a, other = seen.get(key);
    if (other === undefined) {
      seen.set(key, t);
      continue;
    }
    seen.delete(key);
    const dot = faces[3 * t] * faces[3 * other] + faces[3 * t + 1] * faces[3 * other + 1] + faces[3 * t + 2] * faces[3 * other + 2];
    const lengths = Math.hypot(faces[3 * t], faces[3 * t + 1], faces[3 * t + 2]) * Math.hypot(faces[3 * other], faces[3 * other + 1], faces[3 * other + 2]);
    if (dot < sharp * lengths) add(a, b);
  }
  for (const key of seen.keys()) add(Math.floor(key / count), key % count);  // rims of what is open
  return { ends, closed: seen.size === 0 };
}

// {vertices, triangles, edges: of no triangle} -> {solid, lines, points: geometries or null, closed, box, outermost: vertices}
export function solidOf(mesh) {
  const { vertices, triangles, edges } = mesh;
  const faces = faceNormals(vertices, triangles);
  const { ends, closed } = sharpEdges(vertices, triangles, faces);
  for (const v of edges ?? []) ends.push(vertices[3 * v], vertices[3 * v + 1], vertices[3 * v + 2]);
  const made = { solid: null, lines: null, points: null, closed, box: new THREE.Box3().setFromArray(vertices), outermost: outermost(vertices) };
  if (triangles.length > 0) {
    const { positions, normals, index } = smoothed(vertices, triangles, faces);
    made.solid = new THREE.BufferGeometry();
    made.solid.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    made.solid.setAttribute("normal", new THREE.BufferAttribute(normals, 3));
    made.solid.setIndex(new THREE.BufferAttribute(index, 1));
  }
  if (ends.length > 0) {
    made.lines = new THREE.BufferGeometry();
    made.lines.setAttribute("position", new THREE.Float32BufferAttribute(ends, 3));
  }
  if (!made.solid && !made.lines) {
    made.points = new THREE.BufferGeometry();
    made.points.setAttribute("position", new THREE.BufferAttribute(vertices, 3));
  }
  return made;
}
