/** The wall, dragged along its normal: this moves the point where it stands at t = 0. */
import { Vector3 } from "three";
import { at } from "../app/dom.js";
import { later } from "../app/frames.js";
import { rounded, shown, yaml } from "../app/numbers.js";
import { setting } from "../scenario/edit.js";
import { number } from "../scenario/values.js";
import { dot, plateSize, unit } from "../scene/pose.js";
import { Handle } from "./handle.js";

const STEP = 0.005; // of a key, in reaches of the arm
const UP = 0.45; // where an infinite wall is held, in reaches above its point
const DIGITS = 5; // of a coordinate
const LEAST = 10; // px in the picture of a tenth of the reach along the normal: the wall cannot be dragged towards the eye

export class WallHandle extends Handle {
  constructor(store, scene, editor) {
    super(at("wall-handle"), scene);
    Object.assign(this, { store, editor });
    store.on(["resolved"], () => later("wall-handle", () => this.#tell()));
  }

  /** The middle of the upper edge; null where there is no wall, or where its normal points to the eye. */
  pointOf({ wall }) {
    if (!wall) return null;
    const { size, run, view } = this.scene;
    const sides = plateSize(run.resolved.wall);
    const point = new Vector3(...wall.point).addScaledVector(new Vector3(...wall.e2), sides ? sides[1] / 2 : UP * size);
    const [from, to] = [point, point.clone().addScaledVector(new Vector3(...wall.normal), 0.1 * size)].map((one) => view.pixels(one));
    this.along = to.map((part, i) => (part - from[i]) / (0.1 * size)); // px of a metre along the normal
    this.element.style.setProperty("--turn", `${Math.atan2(this.along[1], this.along[0])}rad`);
    return 0.1 * size * Math.hypot(...this.along) < LEAST ? null : point;
  }

  begin(place) {
    const { point, normal } = this.store.get("resolved").wall;
    this.store.set({ playing: false });
    this.hold = { place, point: point.map(number), normal: unit(normal.map(number)), shift: 0, opened: this.store.get("opened") };
    this.joined = false;
  }

  drag(place) {
    const [right, down] = place.map((part, i) => part - this.hold.place[i]);
    const [x, y] = this.along;
    this.#shift((right * x + down * y) / (x * x + y * y));
  }

  /** Right, up and into the depth lead away from the arm. */
  nudge([right, up, near]) {
    if (!this.hold) this.begin();
    this.#shift(this.hold.shift - STEP * this.scene.size * (right + up - near));
  }

  end() {
    this.hold = null;
  }

  /** Put the wall so far, m, from where it was held, along its normal. */
  #shift(shift) {
    const { point, normal, opened } = Object.assign(this.hold, { shift });
    const list = `[${point.map((part, i) => yaml(rounded(part + shift * normal[i], DIGITS))).join(", ")}]`;
    later("wall-shift", () => {
      const change = (text, tree) => (this.store.get("opened") === opened ? setting(text, "wall.point", list, tree) : null);
      this.editor.changeSoon("wall.point", change, this.joined);
      this.joined = true;
    });
  }

  #tell() {
    const { wall } = this.store.get("resolved") ?? {};
    if (!wall) return;
    const away = -dot(wall.point.map(number), unit(wall.normal.map(number)));
    this.element.setAttribute("aria-valuenow", rounded(away));
    this.element.setAttribute("aria-valuetext", `${shown(away)} m from the base at the start`);
  }
}
