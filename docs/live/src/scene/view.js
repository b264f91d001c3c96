/** From where the scene is seen: turned by mouse, touch and buttons. */
import { PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

/** Directions from which the buttons look, base axes. */
export const VIEWS = {
  whole: [0.42, -0.86, 0.34],
  side: [0, -1, 0],
  front: [1, 0, 0.02],
  top: [0, -0.001, 1],
};

export class View {
  constructor(element, changed) {
    this.camera = new PerspectiveCamera(34, 1, 0.01, 1000);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, element);
    this.controls.addEventListener("change", changed);
    this.controls.enableDamping = false;
    this.target = new Vector3();
    this.distance = 1;
  }

  /** Look at what the arm of this size can reach. */
  frame(size, floor) {
    this.camera.near = 0.01 * size;
    this.camera.far = 60 * size;
    this.target.set(0.45 * size, 0, 0.3 * floor);
    this.span = size;
    this.look(this.name ?? "whole");
  }

  /** name: one of VIEWS. */
  look(name) {
    this.name = name;
    const [x, y, z] = VIEWS[name];
    const wide = Math.max(1, 1.25 / this.camera.aspect);
    this.distance = 2.15 * this.span * wide;
    this.camera.position.copy(this.target).add(new Vector3(x, y, z).normalize().multiplyScalar(this.distance));
    this.controls.target.copy(this.target);
    this.camera.updateProjectionMatrix();
    this.controls.update();
  }

  resize(width, height) {
    this.camera.aspect = width / height;
    if (this.span) this.look(this.name ?? "whole");
    this.camera.updateProjectionMatrix();
  }
}
