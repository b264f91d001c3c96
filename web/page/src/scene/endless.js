/** An infinite wall: a plane and a grid on it that fade far from the arm; the grid shows the wall seen from its edge, too. */
import { BufferAttribute, BufferGeometry, DoubleSide, Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, PlaneGeometry } from "three";

const SQUARES = 24; // along a side
const SQUARE = 0.25; // side of a square, in reaches of the arm
const CLEAR = 0.1; // share of the way to the rim up to which nothing fades

export class Endless {
  constructor() {
    const look = { transparent: true, depthWrite: false, vertexColors: true };
    this.face = new MeshBasicMaterial({ ...look, opacity: 0.13, side: DoubleSide });
    this.lines = new LineBasicMaterial({ ...look, opacity: 0.5 });
    const plane = new Mesh(fading(new PlaneGeometry(2, 2, SQUARES, SQUARES)), this.face);
    this.object = new Group().add(plane, new LineSegments(fading(grid()), this.lines));
  }

  colour(face, edge) {
    this.face.color.set(face);
    this.lines.color.set(edge);
  }

  /** size: of the arm, m. */
  place(size) {
    this.object.scale.setScalar((SQUARES / 2) * SQUARE * size);
  }
}

/** Lines from -1 to 1, cut where they cross. */
function grid() {
  const at = (i) => (2 * i) / SQUARES - 1;
  const ends = [];
  for (let i = 0; i <= SQUARES; i += 1) {
    for (let k = 0; k < SQUARES; k += 1) ends.push(at(i), at(k), 0, at(i), at(k + 1), 0, at(k), at(i), 0, at(k + 1), at(i), 0);
  }
  return new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(ends), 3));
}

/** A geometry whose points are the more transparent the farther they lie from the origin. */
function fading(geometry) {
  const { array, count } = geometry.attributes.position;
  const colours = new Float32Array(4 * count).fill(1);
  for (let i = 0; i < count; i += 1) {
    const faded = (Math.hypot(array[3 * i], array[3 * i + 1]) - CLEAR) / (1 - CLEAR);
    colours[4 * i + 3] = Math.min(1, Math.max(0, 1 - faded)) ** 2;
  }
  return geometry.setAttribute("color", new BufferAttribute(colours, 4));
}
