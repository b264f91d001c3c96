/** From where the scene is seen: turned by mouse, touch and buttons. */
import { Box3, PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

/** Directions from which the buttons look, base axes. */
export const VIEWS = {
  whole: [0.42, -0.86, 0.34],
  side: [0, -1, 0],
  front: [1, 0, 0.02],
  top: [0, -0.001, 1],
};

const MARGIN = 0.95; // of the ball around what is seen: the points lie inside, seldom on it

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

  /** Look at these points. size: of the arm, m. */
  frame(points, size) {
    this.camera.near = 0.01 * size;
    this.camera.far = 60 * size;
    const box = new Box3().setFromPoints(points.map((point) => new Vector3(...point)));
    box.getCenter(this.target);
    this.span = Math.max(0.5 * size, MARGIN * box.getSize(new Vector3()).length() * 0.5);
    this.look(this.name ?? "whole");
  }

  /** name: one of VIEWS. */
  look(name) {
    this.name = name;
    const [x, y, z] = VIEWS[name];
    const half = (this.camera.fov / 2) * (Math.PI / 180);
    this.distance = this.span / Math.sin(Math.min(half, Math.atan(Math.tan(half) * this.camera.aspect)));
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
