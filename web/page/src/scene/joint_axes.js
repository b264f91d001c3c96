/** The joints' axes with their positive directions: an arrow along each axis, and an arc with a head around it. */
import { ConeGeometry, Group, Mesh, MeshStandardMaterial, Quaternion, TorusGeometry, Vector3 } from "three";
import { JOINTS } from "../app/colours.js";
import { Arrow } from "./arrow.js";
import { piece } from "./piece.js";

const ARC = 1.5 * Math.PI;
const CHORDS = 8; // that an arc is for labels
const Z = new Vector3(0, 0, 1);

export class JointAxes {
  constructor() {
    this.axes = JOINTS.map((colour) => new JointAxis(colour));
    this.object = new Group().add(...this.axes.map((axis) => axis.object));
  }

  place({ points, axes }, size) {
    const above = points[1].map((part, i) => part + 0.03 * size * axes[0][i]);
    [above, points[2], points[4]].forEach((point, i) => this.axes[i].place(point, axes[i], size));
  }

  /** What labels must not cover. */
  get pieces() {
    return this.object.visible ? this.axes.flatMap((axis) => axis.pieces) : [];
  }

  /** The arrows, at whose ends the labels stand. */
  get arrows() {
    return this.axes.map((axis) => axis.arrow);
  }
}

class JointAxis {
  constructor(colour) {
    const material = new MeshStandardMaterial({ color: colour, roughness: 0.6 });
    this.arrow = new Arrow(colour, 1);
    this.arc = new Mesh(new TorusGeometry(1, 0.07, 10, 48, ARC), material);
    this.head = new Mesh(new ConeGeometry(0.2, 0.5, 16), material);
    this.head.position.set(Math.cos(ARC), Math.sin(ARC), 0);
    this.head.rotation.z = ARC; // a cone points along +y, and the arc ends in the direction (-sin, cos)
    this.turn = new Group().add(this.arc, this.head);
    this.object = new Group().add(this.arrow.object, this.turn);
  }

  place(point, axis, size) {
    const direction = new Vector3(...axis);
    const from = new Vector3(...point);
    this.arrow.thickness = 0.005 * size;
    this.arrow.point(from, direction.clone().multiplyScalar(0.17 * size));
    this.turn.scale.setScalar(0.055 * size);
    this.turn.position.copy(from).addScaledVector(direction, 0.1 * size);
    this.turn.quaternion.copy(new Quaternion().setFromUnitVectors(Z, direction));
  }

  get pieces() {
    this.turn.updateMatrix();
    const at = (i) => new Vector3(Math.cos((i / CHORDS) * ARC), Math.sin((i / CHORDS) * ARC), 0).applyMatrix4(this.turn.matrix);
    const chords = Array.from({ length: CHORDS }, (_, i) => piece(at(i), at(i + 1), 0.2 * this.turn.scale.x));
    return [...this.arrow.pieces, ...chords];
  }
}
