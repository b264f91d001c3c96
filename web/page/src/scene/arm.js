/** The arm: a column on axis 1, links with their offsets, and a body at joints 2 and 3. */
import { BoxGeometry, CylinderGeometry, Group, Matrix4, Mesh, MeshStandardMaterial, SphereGeometry, Vector3 } from "three";
import { piece } from "./piece.js";
import { cross, unit } from "./pose.js";

/** The bars between the arm's points, from axis 1 on: thickness, of size, and whether it lies along a joint's axis. */
const BARS = [[0.036, false], [0.036, false], [0.036, true], [0.026, false], [0.026, true]]; // prettier-ignore

export class ArmModel {
  /** look: what all its materials have in common. */
  constructor(look = {}) {
    this.links = new MeshStandardMaterial({ roughness: 0.45, metalness: 0.25, ...look });
    this.joints = new MeshStandardMaterial({ roughness: 0.5, metalness: 0.2, ...look });
    this.end = new MeshStandardMaterial({ roughness: 0.4, ...look });
    this.column = new Mesh(new CylinderGeometry(1, 1.25, 1, 32), this.links);
    this.bars = BARS.map(() => new Mesh(new BoxGeometry(1, 1, 1), this.links));
    this.bodies = [0, 1].map(() => new Mesh(new CylinderGeometry(1, 1, 1, 32), this.joints));
    this.tip = new Mesh(new SphereGeometry(1, 24, 16), this.end);
    this.object = new Group().add(this.column, ...this.bars, ...this.bodies, this.tip);
  }

  colour(theme) {
    this.links.color.set(theme.link);
    this.joints.color.set(theme.joint);
    this.end.color.set(theme.tip);
  }

  /** size: what the thickness of the parts goes by, m; floor: height of the floor, m. */
  place({ points, axes, up, tip }, size, floor) {
    this.#placeColumn(points[1], up, size, floor);
    const along = [points[3], points[5]].map((end, i) => end.map((part, k) => part - points[2 + 2 * i][k]));
    const sides = [axes[1], axes[1], along[0], axes[2], along[1]];
    BARS.forEach(([thickness, isOffset], i) => {
      bar(this.bars[i], points[i + 1], points[i + 2], sides[i], thickness * size, isOffset);
    });
    [points[2], points[4]].forEach((point, i) => {
      this.bodies[i].scale.set((i ? 0.034 : 0.046) * size, (i ? 0.06 : 0.08) * size, (i ? 0.034 : 0.046) * size);
      orient(this.bodies[i], along[i], axes[i + 1], point);
    });
    this.tip.scale.setScalar(0.021 * size);
    this.tip.position.set(...tip);
    this.pieces = this.#pieces(points, axes, size);
  }

  /** What labels must not cover. */
  #pieces(points, axes, size) {
    const bars = BARS.map(([thickness], i) => piece(points[i + 1], points[i + 2], 0.6 * thickness * size));
    const bodies = [2, 4].map((i) => {
      const ends = [-1, 1].map((side) => points[i].map((part, k) => part + 0.04 * side * size * axes[i / 2][k]));
      return piece(...ends, 0.046 * size);
    });
    const foot = this.column.position.toArray().map((part, k) => 2 * part - points[1][k]);
    return [...bars, ...bodies, piece(foot, points[1], 0.04 * size), piece(points[6], points[6], 0.021 * size)];
  }

  /** Down to the floor; short where axis 1 leads to no floor. */
  #placeColumn(top, up, size, floor) {
    const length = up[2] > 0.5 ? Math.max(1e-6, (top[2] - floor) / up[2]) : 0.25 * size;
    this.column.scale.set(0.035 * size, length, 0.035 * size);
    this.column.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), new Vector3(...up));
    this.column.position.set(...top.map((part, i) => part - (length / 2) * up[i]));
  }
}

/** A box from one point to another, narrow along `side`; an offset ends on the far sides of its neighbours. */
function bar(mesh, from, to, side, thickness, isOffset) {
  const along = to.map((value, i) => value - from[i]);
  const length = Math.hypot(...along);
  mesh.visible = length > 1e-9;
  if (!mesh.visible) return;
  orient(mesh, along, side, from.map((value, i) => (value + to[i]) / 2));
  mesh.scale.set(length + (isOffset ? 0.8 * thickness : 0), 0.8 * thickness, thickness);
}

/** Turn a mesh so that its x and y axes lie along two directions that are at right angles. */
function orient(mesh, x, y, position) {
  const [a, b] = [unit(x), unit(y)];
  const basis = [a, b, cross(a, b)].map((axis) => new Vector3(...axis));
  mesh.quaternion.setFromRotationMatrix(new Matrix4().makeBasis(...basis));
  mesh.position.set(...position);
}
