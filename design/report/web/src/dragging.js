// SPDX-License-Identifier: MIT
// A body dragged in the picture moves the joint that it hangs on: the joint's value is the one that brings the grabbed point nearest to the
// pointer. How the point goes with the joint is a screw, known from two poses.
import * as THREE from "three";

import { byId, element } from "./dom.js";

const leastMove = 3;  // pixels: less is a click
const searches = [1 / 4, 1 / 4, 1 / 48, 1 / 600], samples = 12;  // shares of a joint's range that are looked through to each side, one in the other
const probe = 1 / 360;  // of a joint's range
const leastTurn = 1e-5;  // rad: less is rounding of poses

const poseOf = (poses, body) => ({ at: new THREE.Vector3(...poses.subarray(7 * body, 7 * body + 3)), turn: new THREE.Quaternion(...poses.subarray(7 * body + 3, 7 * body + 7)).normalize() });

// Where a point of the world is taken by `step` (by one: from the first pose to the second).
export function screw(first, second) {
  const turn = second.turn.clone().multiply(first.turn.clone().invert()), axis = new THREE.Vector3(turn.x, turn.y, turn.z).multiplyScalar(turn.w < 0 ? -1 : 1);
  const angle = 2 * Math.atan2(axis.length(), Math.abs(turn.w)), shift = second.at.clone().sub(first.at);
  if (angle < leastTurn) return (point, step) => point.clone().addScaledVector(shift, step);
  axis.normalize();
  const moved = second.at.clone().sub(first.at.clone().applyQuaternion(turn)), along = moved.dot(axis);
  moved.addScaledVector(axis, -along);
  const centre = moved.clone().addScaledVector(axis.clone().cross(moved), 1 / Math.tan(angle / 2)).multiplyScalar(0.5);
  return (point, step) => point.clone().sub(centre).applyAxisAngle(axis, angle * step).add(centre).addScaledVector(axis, along * step);
}

export class Dragging {
  constructor(viewer, joints) {
    Object.assign(this, { viewer, joints, ray: new THREE.Raycaster(), label: element("span", { class: "body-label", "aria-hidden": "true", hidden: true }) });
    const { canvas } = viewer;
    byId("viewport").append(this.label);
    canvas.addEventListener("pointerdown", (event) => this.grab(event), true);  // before the camera's controls
    canvas.addEventListener("pointermove", (event) => (this.drag ? this.pull(event) : this.hover(event)));
    canvas.addEventListener("pointerleave", () => !this.drag && this.name(null));
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) canvas.addEventListener(end, (event) => event.pointerId === this.drag?.id && this.drop());
  }

  place(event) {
    const box = this.viewer.canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top, width: box.width, height: box.height };
  }

  // What is seen there: {index, point, joint} of a body that a joint moves, or null.
  found(event) {
    const { viewer, ray } = this, { x, y, width, height } = this.place(event), { section } = viewer;
    if (viewer.exploded > 0) return null;
    ray.setFromCamera(new THREE.Vector2((2 * x) / width - 1, 1 - (2 * y) / height), viewer.camera);
    let best = null;
    viewer.mechanism(viewer.mode).parts.forEach(({ group, meshes }, index) => {
      if (!group.visible) return;
      const hit = ray.intersectObjects(meshes.filter((mesh) => mesh.isMesh && mesh.visible), false).find(({ point }) => !section || point.dot(section.normal) <= section.offset);
      if (hit && !(hit.distance >= best?.distance)) best = { index, point: hit.point, distance: hit.distance, joint: this.joints.of(viewer.bodies[index].name) };
    });
    return best?.joint ? best : null;
  }

  hover(event) {
    if (event.buttons || event.pointerType === "touch" || !this.joints.joints.length) return this.name(null);
    this.asked ??= requestAnimationFrame(() => {
      this.asked = null;
      if (!this.drag) this.name(this.found(this.hovered), this.hovered);
    });
    this.hovered = event;
  }

  // Tells the body under the pointer.
  name(found, event) {
    this.viewer.canvas.style.cursor = !found ? "auto" : this.drag ? "grabbing" : "grab";
    this.label.hidden = !found;
    if (!found) return;
    const { x, y, width } = this.place(event), body = this.viewer.bodies[found.index].name;
    this.label.textContent = body === found.joint.name ? body : `${body} (${found.joint.name})`;
    this.label.style.cssText = `${x > width / 2 ? `right: ${width - x + 14}px` : `left: ${x + 14}px`}; top: ${y + 14}px`;
  }

  grab(event) {
    if (this.drag || event.button !== 0 || event.ctrlKey || event.metaKey || event.shiftKey) return;
    const found = this.joints.root.disabled ? null : this.found(event);
    if (!found) return;
    const { group } = this.viewer.mechanism(this.viewer.mode).parts[found.index];
    this.viewer.controls.enabled = false;
    this.viewer.canvas.setPointerCapture(event.pointerId);
    this.drag = { ...found, id: event.pointerId, from: this.place(event), local: group.worldToLocal(found.point.clone()), epoch: this.joints.epoch };
    this.name(found, event);
  }

  drop() {
    this.drag = null;
    this.viewer.canvas.style.cursor = "auto";
    this.viewer.controls.enabled = true;
  }

  pull(event) {
    const { drag } = this;
    if (event.pointerId !== drag.id) return;
    drag.to = this.place(event);
    if (drag.epoch !== this.joints.epoch) return this.drop();  // other parts, or the motion again
    if (!drag.began && Math.hypot(drag.to.x - drag.from.x, drag.to.y - drag.from.y) < leastMove) return;
    if (drag.began) return this.follow(drag);
    drag.began = this.label.hidden = true;  // not over what is told of its distances
    this.begin(drag).catch(() => this.drag === drag && this.drop());
  }

  // How the grabbed point goes with the joint, from where the joints are.
  async begin(drag) {
    const { joints } = this, { values } = joints, { name, low, high } = drag.joint, reach = high - low, step = probe * reach * (values[name] + probe * reach > high ? -1 : 1);
    const first = await joints.asked(values, false), second = first && (await joints.asked({ ...values, [name]: values[name] + step }, false));
    if (!second || this.drag !== drag) return;
    const here = poseOf(first.poses, drag.index), way = screw(here, poseOf(second.poses, drag.index)), point = drag.local.clone().applyQuaternion(here.turn).add(here.at);
    Object.assign(drag, { value: values[name], at: (value) => way(point, (value - values[name]) / step) });
    this.follow(drag);
  }

  follow(drag) {
    if (!drag.at) return;
    const { viewer } = this, { name, low, high } = drag.joint, size = viewer.renderer.getSize(new THREE.Vector2());
    const away = (value) => {
      const { x, y } = viewer.project(drag.at(value), size);
      return Math.hypot(x - drag.to.x, y - drag.to.y);
    };
    for (const share of searches) {
      let best = drag.value, least = away(best);
      for (let k = 1; k <= samples; ++k)
        for (const side of [-1, 1]) {
          const value = Math.min(high, Math.max(low, drag.value + (side * share * (high - low) * k) / samples)), distance = away(value);
          if (distance < least - 1e-6) [best, least] = [value, distance];
        }
      drag.value = best;
    }
    this.joints.move({ [name]: drag.value });
  }
}
