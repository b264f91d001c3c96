/** The run before, to compare with: its arm at the present time, pale, and the path of its tip. */
import { Group } from "three";
import { ArmModel } from "./arm.js";
import { Path } from "./path.js";
import { poseAt } from "./pose.js";

const SAME = 2e-3; // reaches of the arm: a ghost that lies nearer to the arm is not drawn

export class Ghost {
  constructor() {
    this.arm = new ArmModel({ transparent: true, opacity: 0.35 });
    this.path = new Path({ linewidth: 1.5, transparent: true, opacity: 0.6 });
    this.object = new Group().add(this.arm.object, this.path.line);
    this.object.visible = false;
  }

  colour({ faint }) {
    this.arm.colour({ link: faint, joint: faint, tip: faint });
    this.path.material.color.set(faint);
  }

  /** Take another run; null: there is none. */
  show(run) {
    this.run = run;
    this.object.visible = Boolean(run);
    if (run) this.path.set(["x", "y", "z"].map((axis) => run.columns[`tip_${axis}`]));
  }

  /** Stand as at a time, s, where the arm of the present run has this pose. */
  place(time, { points }, size, floor) {
    if (!this.object.visible) return;
    const own = poseAt(this.run, time);
    const apart = Math.max(...points.map((point, i) => Math.hypot(...point.map((part, k) => part - own.points[i][k]))));
    this.arm.object.visible = apart > SAME * size;
    this.arm.place(own, this.run.arm.reach, floor);
  }

  /** What labels must not cover. */
  get pieces() {
    return this.object.visible && this.arm.object.visible ? this.arm.pieces : [];
  }
}
