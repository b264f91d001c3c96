/** The tip, dragged to where the run is to begin with it: the pose comes from inverse kinematics, within reach. */
import { Vector3 } from "three";
import { at } from "../app/dom.js";
import { later } from "../app/frames.js";
import { DEGREE, fixed, rounded, yaml } from "../app/numbers.js";
import { setting } from "../scenario/edit.js";
import { poseAt } from "../scene/pose.js";
import { Handle } from "./handle.js";

const STEP = 0.005; // of a key, in reaches of the arm
const DIGITS = 5; // of an angle in degrees

export class TipHandle extends Handle {
  constructor(store, scene, { editor, simulation, transport }) {
    super(at("tip-handle"), scene);
    Object.assign(this, { store, editor, simulation, transport, wanted: null, asked: 0 });
    store.on(["run"], () => later("tip-handle", () => this.#tell(this.#start())));
  }

  pointOf(pose) {
    return new Vector3(...pose.tip);
  }

  begin() {
    this.transport.seek(-Infinity);
    this.from = this.#start();
    this.joined = false;
  }

  drag(place) {
    this.#want(this.scene.view.pointAt(place, this.from));
  }

  nudge(step) {
    if (!this.wanted) this.begin();
    const point = (this.wanted ?? this.from).clone();
    this.scene.view.axes.forEach((axis, i) => point.addScaledVector(axis, STEP * step[i] * this.scene.size));
    this.#want(point);
  }

  end() {
    this.wanted = null;
  }

  /** Of the tip, when the run begins. */
  #start() {
    const run = this.store.get("run");
    return this.pointOf(poseAt(run, run.columns.t[0]));
  }

  #want(point) {
    this.wanted = point;
    later("tip-wanted", () => this.#ask(point));
  }

  /** An answer that a newer question has overtaken is not used. */
  async #ask(point) {
    const number = (this.asked += 1);
    const opened = this.store.get("opened");
    const pose = await this.simulation.pose(point.toArray()).catch(() => null);
    if (!pose || number !== this.asked || opened !== this.store.get("opened")) return;
    this.wanted?.set(...pose.tip); // within reach
    const list = `[${pose.q.map((angle) => `${yaml(rounded(angle / DEGREE, DIGITS))} deg`).join(", ")}]`;
    this.editor.changeSoon("initial.q", (text, tree) => setting(text, "initial.q", list, tree), this.joined);
    this.joined = true;
  }

  #tell(tip) {
    const place = tip.toArray().map((part) => fixed(part, 3)).join(", ");
    this.element.setAttribute("aria-label", `Tip at the start: ${place} m. Arrow keys move it in the picture, Page up and down in depth`);
  }
}
