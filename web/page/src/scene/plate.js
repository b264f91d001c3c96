/** The moving wall, or the virtual wall of a controller: a plate that lets the arm be seen through it. */
import {
  BoxGeometry, DoubleSide, EdgesGeometry, Group, LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshStandardMaterial,
  PlaneGeometry, Vector3,
} from "three";

const INFINITE = 0.5; // half side of an infinite wall as it is drawn, in reaches of the arm

export class Plate {
  constructor() {
    this.face = new MeshStandardMaterial({ transparent: true, opacity: 0.2, side: DoubleSide, roughness: 0.9, depthWrite: false });
    this.edge = new LineBasicMaterial();
    const front = new Mesh(new PlaneGeometry(1, 1), this.face);
    this.lines = new LineSegments(new EdgesGeometry(new BoxGeometry(1, 1, 1)), this.edge);
    this.lines.position.z = -0.5; // the plate lies behind its face
    this.object = new Group().add(front, this.lines);
  }

  colour(face, edge) {
    this.face.color.set(face);
    this.edge.color.set(edge);
  }

  /** point: a point of the face; sides: m, or null for an infinite plate. */
  place({ point, e1, e2, normal, sides }, size) {
    const [a, b] = sides ?? [2 * INFINITE * size, 2 * INFINITE * size];
    this.lines.visible = Boolean(sides);
    this.object.position.set(...point);
    const basis = new Matrix4().makeBasis(...[e2, e1, normal].map((axis) => new Vector3(...axis)));
    this.object.quaternion.setFromRotationMatrix(basis);
    this.object.scale.set(b, a, 0.015 * size); // e2, e1 and the normal are right-handed in this order
  }
}
