/** From where the scene is seen, turned by mouse, touch and buttons: in perspective, or along an axis without it. */
import { OrthographicCamera, PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

/** Directions from which the buttons look, base axes; the whole is seen in perspective, the others are orthographic. */
export const VIEWS = {
  whole: [0.42, -0.86, 0.34],
  side: [0, -1, 0],
  front: [1, 0, 0],
  top: [0, -1e-4, 1], // not quite along the camera's "up"
};

const MARGIN = 0.1; // reaches of the arm, around the points to be seen
const [ABOVE, BELOW] = [44, 70]; // px of the picture that buttons and legends take
const LEAST = 60; // px, of what is left
const SLOPE = Math.tan((17 * Math.PI) / 180); // of the upper edge of the perspective
const FAR = 20; // reaches of the arm, to the eye of an orthographic view

export class View {
  constructor(element, changed) {
    this.perspective = new PerspectiveCamera((2 * Math.atan(SLOPE) * 180) / Math.PI);
    this.orthographic = new OrthographicCamera();
    this.camera = this.perspective;
    for (const camera of [this.perspective, this.orthographic]) camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, element);
    this.controls.addEventListener("change", changed);
    this.controls.addEventListener("start", () => (this.moved = true));
    this.controls.enableDamping = false;
    this.camera.position.set(...VIEWS.whole);
    this.controls.update();
  }

  /** Look at these points, from where the present ones are seen. size: of the arm, m. stays: the picture stays for now. */
  frame(points, size, stays) {
    this.points = points.map((point) => new Vector3(...point));
    this.size = size;
    if (!stays) this.#fit(this.axes);
  }

  /** name: one of VIEWS. */
  look(name) {
    const camera = name === "whole" ? this.perspective : this.orthographic;
    this.camera = this.controls.object = camera;
    this.#fit(axesTowards(new Vector3(...VIEWS[name]).normalize()));
  }

  resize(width, height) {
    Object.assign(this, { width, height });
    this.#fit(this.axes);
  }

  /** Whether the picture may stay for these points: it holds them, or somebody has moved it. */
  serves(points) {
    return this.moved || points.every((point) => {
      const [x, y] = this.pixels(new Vector3(...point));
      return x >= 0 && y >= 0 && x <= this.width && y <= this.height;
    }); // prettier-ignore
  }

  /** Put the eye where all points are in the free part of the picture, and fill it. axes: as below. */
  #fit(axes) {
    if (!this.points || !this.width) return;
    this.moved = false;
    const free = Math.max(LEAST, this.height - ABOVE - BELOW);
    const seen = this.points.map((point) => axes.map((axis) => axis.dot(point)));
    const ends = axes.map((_, i) => [Math.min(...seen.map((one) => one[i])), Math.max(...seen.map((one) => one[i]))]);
    const middle = ends.map(([low, high]) => (low + high) / 2);
    const half = ([x, y]) => Math.max(Math.abs(y) / free, Math.abs(x) / this.width) * this.height; // of a picture that holds a point
    const around = seen.map((one) => one.map((part, i) => part - middle[i]));
    const padded = around.map(([x, y, z]) => [Math.abs(x) + MARGIN * this.size, Math.abs(y) + MARGIN * this.size, z]);
    this.half = Math.max(...padded.map(half));
    const isFlat = this.camera === this.orthographic;
    const distance = isFlat ? FAR * this.size : Math.max(...padded.map((one) => half(one) / SLOPE + one[2]));
    this.controls.target.set(0, 0, 0);
    axes.forEach((axis, i) => this.controls.target.addScaledVector(axis, middle[i]));
    this.camera.position.copy(this.controls.target).addScaledVector(axes[2], distance);
    this.#shape();
    this.controls.update();
  }

  /** Where a point (Vector3) stands in the picture, from its upper left corner: [x, y], px. */
  pixels(point) {
    const { x, y } = point.clone().project(this.camera);
    return [((x + 1) / 2) * this.width, ((1 - y) / 2) * this.height];
  }

  /** What stands at a place of the picture, px, in the plane through a point that is parallel to the picture. */
  pointAt([x, y], through) {
    const { z } = through.clone().project(this.camera);
    return new Vector3((2 * x) / this.width - 1, 1 - (2 * y) / this.height, z).unproject(this.camera);
  }

  /** Unit vectors to the right, up, and towards the eye. */
  get axes() {
    return [0, 1, 2].map((i) => new Vector3().setComponent(i, 1).applyQuaternion(this.camera.quaternion));
  }

  #shape() {
    const { width, height, half, size, camera } = this;
    const wide = (half * width) / height;
    Object.assign(this.perspective, { aspect: width / height });
    Object.assign(this.orthographic, { left: -wide, right: wide, top: half, bottom: -half, zoom: 1 });
    Object.assign(camera, { near: 0.01 * size, far: 60 * size });
    camera.setViewOffset(width, height, 0, (BELOW - ABOVE) / 2, width, height);
  }
}

/** Right, up and towards the eye. */
function axesTowards(direction) {
  const right = new Vector3(0, 0, 1).cross(direction).normalize();
  return [right, direction.clone().cross(right), direction];
}
