/** The path of the tip: all of it faint, up to the present time strong; and the path of its reference. */
import { Group } from "three";
import { rowAt } from "../simulate/thin.js";
import { Path } from "./path.js";

export class Trace {
  constructor() {
    this.whole = new Path({ linewidth: 1.5, transparent: true, opacity: 0.35 });
    this.past = new Path({ linewidth: 3 });
    this.reference = new Path({ linewidth: 1.5, dashed: true });
    this.object = new Group().add(this.whole.line, this.past.line, this.reference.line);
  }

  colour(theme) {
    this.whole.material.color.set(theme.tip);
    this.past.material.color.set(theme.tip);
    this.reference.material.color.set(theme.ink);
  }

  resize(width, height) {
    for (const path of [this.whole, this.past, this.reference]) path.material.resolution.set(width, height);
  }

  /** Take the paths of another run. size: what the dashes go by, m. */
  show({ columns }, size) {
    const points = (name) => ["x", "y", "z"].map((axis) => columns[`${name}_${axis}`]);
    this.rows = this.whole.set(points("tip"));
    this.times = Float64Array.from(this.rows, (row) => columns.t[row]);
    this.past.set(points("tip"), this.rows);
    this.reference.material.dashSize = this.reference.material.gapSize = 0.012 * size;
    this.reference.line.visible = "tip_ref_x" in columns;
    if (this.reference.line.visible) this.reference.set(points("tip_ref"));
  }

  /** Draw what has been passed at a time; ahead: also what comes after it. */
  upTo(time, { ahead }) {
    this.whole.line.visible = ahead;
    const passed = rowAt(this.times, time);
    this.past.line.geometry.instanceCount = passed;
    this.past.line.visible = passed > 0;
  }
}
