/** An arrow: a shaft and a head, both as thick as seen best, whatever the length. */
import { ConeGeometry, CylinderGeometry, Group, Mesh, MeshStandardMaterial, Quaternion, Vector3 } from "three";
import { piece } from "./piece.js";

const UP = new Vector3(0, 1, 0);

export class Arrow {
  constructor(colour, thickness) {
    this.thickness = thickness;
    this.material = new MeshStandardMaterial({ color: colour, roughness: 0.6 });
    this.shaft = new Mesh(new CylinderGeometry(1, 1, 1, 12), this.material);
    this.head = new Mesh(new ConeGeometry(1, 1, 20), this.material);
    this.object = new Group().add(this.shaft, this.head);
    this.tip = new Vector3();
  }

  /** From a point along a vector; one without length is not seen. */
  point(from, vector) {
    const size = vector.length();
    this.object.visible = size > 1e-9;
    if (!this.object.visible) return;
    const head = Math.min(5 * this.thickness, 0.6 * size);
    this.shaft.scale.set(this.thickness, size - head, this.thickness);
    this.shaft.position.set(0, (size - head) / 2, 0);
    this.head.scale.set(2.6 * this.thickness, head, 2.6 * this.thickness);
    this.head.position.set(0, size - head / 2, 0);
    this.object.position.copy(from);
    this.object.quaternion.copy(new Quaternion().setFromUnitVectors(UP, vector.clone().normalize()));
    this.tip.copy(from).add(vector);
    this.from = from;
  }

  /** What labels must not cover. */
  get pieces() {
    return this.object.visible ? [piece(this.from, this.tip, 2.6 * this.thickness)] : [];
  }
}
