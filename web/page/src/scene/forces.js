/** Both contact forces: on the wall and on the tip, from the point of contact, on one scale. */
import { Group, Vector3 } from "three";
import { ON_TIP, ON_WALL } from "../app/colours.js";
import { shown } from "../app/numbers.js";
import { Arrow } from "./arrow.js";

const LONGEST = 0.3; // of an arrow, in reaches of the arm

export class Forces {
  constructor() {
    this.onWall = new Arrow(ON_WALL, 1);
    this.onTip = new Arrow(ON_TIP, 1);
    this.object = new Group().add(this.onWall.object, this.onTip.object);
    this.largest = 0;
  }

  /** Take the scale of another run: its largest force has the longest arrow. */
  show({ columns }) {
    this.largest = 0;
    const [x, y, z] = ["x", "y", "z"].map((axis) => columns[`f_on_wall_${axis}`]);
    for (let i = 0; i < x.length; i += 1) {
      this.largest = Math.max(this.largest, Math.hypot(x[i], y[i], z[i]));
    }
  }

  /** What labels must not cover. */
  get pieces() {
    return [...this.onWall.pieces, ...this.onTip.pieces];
  }

  place({ tip, forceOnWall, forceOnTip }, size) {
    const scale = this.largest > 0 ? (LONGEST * size) / this.largest : 0;
    for (const [arrow, force] of [[this.onWall, forceOnWall], [this.onTip, forceOnTip]]) {
      arrow.thickness = 0.008 * size;
      arrow.point(new Vector3(...tip), new Vector3(...force).multiplyScalar(scale));
      const newtons = Math.hypot(...force);
      arrow.text = arrow.object.visible ? `${shown(newtons, 3)} N` : "";
    }
  }
}
