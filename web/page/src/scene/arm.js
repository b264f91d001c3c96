/** The arm: a column on joint 1, two links, and a body at each joint. */
import { BoxGeometry, CylinderGeometry, Group, Matrix4, Mesh, MeshStandardMaterial, SphereGeometry, Vector3 } from "three";
import { cross, unit } from "./pose.js";

export class ArmModel {
  constructor() {
    this.links = new MeshStandardMaterial({ roughness: 0.45, metalness: 0.25 });
    this.joints = new MeshStandardMaterial({ roughness: 0.5, metalness: 0.2 });
    this.end = new MeshStandardMaterial({ roughness: 0.4 });
    this.column = new Mesh(new CylinderGeometry(1, 1.25, 1, 32), this.links);
    this.upper = new Mesh(new BoxGeometry(1, 1, 1), this.links);
    this.fore = new Mesh(new BoxGeometry(1, 1, 1), this.links);
    this.bodies = [0, 1].map(() => new Mesh(new CylinderGeometry(1, 1, 1, 32), this.joints));
    this.tip = new Mesh(new SphereGeometry(1, 24, 16), this.end);
    this.object = new Group().add(this.column, this.upper, this.fore, ...this.bodies, this.tip);
  }

  colour(theme) {
    this.links.color.set(theme.link);
    this.joints.color.set(theme.joint);
    this.end.color.set(theme.tip);
  }

  /** size: what the thickness of the parts goes by, m; floor: height of the floor, m. */
  place({ shoulder, elbow, tip, jointAxis }, size, floor) {
    const height = Math.max(1e-6, shoulder[2] - floor);
    this.column.scale.set(0.035 * size, height, 0.035 * size);
    this.column.rotation.set(Math.PI / 2, 0, 0);
    this.column.position.set(0, 0, floor + height / 2);
    bar(this.upper, shoulder, elbow, jointAxis, 0.036 * size);
    bar(this.fore, elbow, tip, jointAxis, 0.026 * size);
    [shoulder, elbow].forEach((point, i) => {
      this.bodies[i].scale.set((i ? 0.034 : 0.046) * size, (i ? 0.06 : 0.08) * size, (i ? 0.034 : 0.046) * size);
      orient(this.bodies[i], cross(jointAxis, [0, 0, 1]), jointAxis, point);
    });
    this.tip.scale.setScalar(0.021 * size);
    this.tip.position.set(...tip);
  }
}

/** A box from one point to another. */
function bar(mesh, from, to, axis, thickness) {
  const along = to.map((value, i) => value - from[i]);
  const length = Math.hypot(...along);
  mesh.visible = length > 1e-9;
  if (!mesh.visible) return;
  orient(mesh, along, axis, from.map((value, i) => (value + to[i]) / 2));
  mesh.scale.set(length, 0.8 * thickness, thickness);
}

/** Turn a mesh so that its x and y axes lie along two directions that are at right angles. */
function orient(mesh, x, y, position) {
  const [a, b] = [unit(x), unit(y)];
  const basis = [a, b, cross(a, b)].map((axis) => new Vector3(...axis));
  mesh.quaternion.setFromRotationMatrix(new Matrix4().makeBasis(...basis));
  mesh.position.set(...position);
}
