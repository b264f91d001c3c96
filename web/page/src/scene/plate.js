/** The moving wall, or the virtual wall of a controller: a plate that lets the arm be seen through it. */
import {
  BoxGeometry, DoubleSide, EdgesGeometry, Group, LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshStandardMaterial,
  PlaneGeometry, Vector3,
} from "three";
import { Endless } from "./endless.js";

export class Plate {
  constructor() {
    this.face = new MeshStandardMaterial({ transparent: true, opacity: 0.2, side: DoubleSide, roughness: 0.9, depthWrite: false });
    this.edge = new LineBasicMaterial();
    const front = new Mesh(new PlaneGeometry(1, 1), this.face);
    const lines = new LineSegments(new EdgesGeometry(new BoxGeometry(1, 1, 1)), this.edge);
    lines.position.z = -0.5; // the plate lies behind its face
    this.bounded = new Group().add(front, lines);
    this.endless = new Endless();
    this.object = new Group().add(this.bounded, this.endless.object);
  }

  colour(face, edge) {
    this.face.color.set(face);
    this.edge.color.set(edge);
    this.endless.colour(face, edge);
  }

  /** point: a point of the face; sides: m, or null for an infinite plate. */
  place({ point, e1, e2, normal, sides }, size) {
    this.object.position.set(...point);
    const basis = new Matrix4().makeBasis(...[e2, e1, normal].map((axis) => new Vector3(...axis)));
    this.object.quaternion.setFromRotationMatrix(basis);
    this.bounded.visible = Boolean(sides);
    this.endless.object.visible = !sides;
    if (!sides) return this.endless.place(size);
    this.bounded.scale.set(sides[1], sides[0], 0.015 * size); // e2, e1 and the normal are right-handed in this order
    return undefined;
  }
}
