// SPDX-License-Identifier: MIT
// One design's parts, put where they are at a time.
import * as THREE from "three";

import { indexAt } from "./data.js";

const mostHidingTriangles = 60000, cornersOfPart = 24;

const a = new THREE.Quaternion(), b = new THREE.Quaternion();

export class Mechanism {
  // `view`: times [s], and of each body mesh and poses (x y z qx qy qz qw, one after the other; a single one: it does not move).
  constructor(view, solids, materials) {
    this.times = view.times;
    this.root = new THREE.Group();
    this.parts = view.bodies.map((body, i) => {
      const group = new THREE.Group(), { solid, lines, points, closed } = solids[body.mesh];
      group.matrixAutoUpdate = false;
      const meshes = [];
      if (solid) meshes.push(new THREE.Mesh(solid, closed ? materials[i].whole : materials[i].open), new THREE.Mesh(solid, materials[i].cut));
      if (lines) meshes.push(new THREE.LineSegments(lines, materials[i].lines));
      if (points) meshes.push(new THREE.Points(points, materials[i].lines));
      for (const mesh of meshes) {
        mesh.matrixAutoUpdate = mesh.frustumCulled = false;
        mesh.renderOrder = mesh.isMesh ? 0 : 1;  // lines see the stencil of all solids
      }
      if (solid) meshes[1].visible = false;
      group.add(...meshes);
      this.root.add(group);
      return { group, meshes, poses: body.poses, solid: solids[body.mesh], materials: materials[i], away: new THREE.Vector3(), at: new THREE.Vector3() };
    });
    this.offsets();
  }

  // Which way each part goes when the mechanism is taken apart: from the middle of all to the middle of its own, at the start.
  offsets() {
    this.setTime(this.times[0], 0);
    const all = new THREE.Box3(), boxes = this.parts.map((part) => part.solid.box.clone().applyMatrix4(part.group.matrix));
    for (const box of boxes) all.union(box);
    this.box = all;
    const middle = all.getCenter(new THREE.Vector3()), size = all.getSize(new THREE.Vector3());
    const least = Math.max(size.x, size.y, size.z) || 1;
    this.parts.forEach((part, i) => {
      const own = boxes[i].getCenter(new THREE.Vector3()).sub(middle);
      // Thin stacks come apart along the stack as well as flat ones do along their plane.
      part.away.set((own.x * least) / Math.max(size.x, 0.3 * least), (own.y * least) / Math.max(size.y, 0.3 * least), (own.z * least) / Math.max(size.z, 0.3 * least));
    });
  }

  // What share of the parts that move is hidden by those that do not, seen from far off in this direction; by some of their corners.
  hiddenShare(direction) {
    const moves = (part) => part.poses.length > 7, solids = this.parts.filter((part) => part.meshes[0]?.isMesh);
    const still = solids.filter((part) => !moves(part)).map((part) => part.meshes[0]);
    const size = (mesh) => (mesh.geometry.index ?? mesh.geometry.attributes.position).count / 3;
    if (!still.length || still.reduce((sum, mesh) => sum + size(mesh), 0) > mostHidingTriangles) return 0;
    this.root.updateMatrixWorld(true);
    const ray = new THREE.Raycaster(), corner = new THREE.Vector3(), reach = this.box.getSize(new THREE.Vector3()).length();
    let hidden = 0, all = 0;
    for (const part of solids.filter(moves)) {
      const corners = part.meshes[0].geometry.attributes.position, every = Math.max(1, Math.floor(corners.count / cornersOfPart));
      for (let k = 0; k < corners.count; k += every) {
        corner.fromBufferAttribute(corners, k).applyMatrix4(part.group.matrixWorld);
        ray.set(corner.addScaledVector(direction, 1e-4 * reach), direction);
        hidden += ray.intersectObjects(still, false).length > 0;
        all += 1;
      }
    }
    return all ? hidden / all : 0;
  }

  // `held`: poses to be at instead, of each part the seven numbers of a pose.
  setTime(t, exploded, held = null) {
    const k = indexAt(this.times, t), last = this.times.length - 1;
    const span = k < last ? this.times[k + 1] - this.times[k] : 0;
    const share = span > 0 ? Math.min(1, Math.max(0, (t - this.times[k]) / span)) : 0;
    for (const [n, part] of this.parts.entries()) {
      const still = held || part.poses.length === 7, i = held ? 7 * n : still ? 0 : 7 * k, j = still || k === last ? i : i + 7, p = held ?? part.poses;
      a.set(p[i + 3], p[i + 4], p[i + 5], p[i + 6]);
      b.set(p[j + 3], p[j + 4], p[j + 5], p[j + 6]);
      if (share > 0) a.slerp(b, share);
      part.at.set(p[i] + share * (p[j] - p[i]), p[i + 1] + share * (p[j + 1] - p[i + 1]), p[i + 2] + share * (p[j + 2] - p[i + 2]));
      if (exploded > 0) part.at.addScaledVector(part.away, exploded);
      part.group.matrix.makeRotationFromQuaternion(a).setPosition(part.at);
      part.group.matrixWorldNeedsUpdate = true;
      for (const mesh of part.meshes) mesh.matrixWorldNeedsUpdate = true;
    }
  }

  // Outermost points of all parts over the motion, from some of its instants, each {at, away}: where its part goes when they are taken apart.
  reach() {
    if (this.points) return this.points;
    const count = Math.min(this.times.length, 24);
    this.points = [];
    for (let n = 0; n < count; ++n) {
      this.setTime(this.times[Math.round((n * (this.times.length - 1)) / Math.max(1, count - 1))], 0);
      for (const part of this.parts)
        if (n === 0 || part.poses.length > 7) this.points.push(...part.solid.outermost.map((point) => ({ at: point.clone().applyMatrix4(part.group.matrix), away: part.away })));
    }
    return this.points;
  }

  setSection(on) {
    for (const { meshes, materials, solid } of this.parts) {
      for (const mesh of meshes) {
        if (!mesh.isMesh) mesh.material = on ? materials.keptLines : materials.lines;
        else if (mesh.material === materials.cut) mesh.visible = on;
        else mesh.material = on ? materials.kept : solid.closed ? materials.whole : materials.open;
      }
    }
  }
}
