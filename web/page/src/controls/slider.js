/** A number of the scenario as a slider, with the number beside it to be typed. */
import { make } from "../app/dom.js";
import { later } from "../app/frames.js";
import { DEGREE, rounded, yaml } from "../app/numbers.js";
import { isAngle, numberAt, position, rangeOf } from "./ranges.js";

const ITEMS = { 3: { joint: ["1", "2", "3"], axis: ["x", "y", "z"] } };
const OF_JOINTS = /^(q|qd|q_amplitude|joint_stiffness|joint_damping|damping|friction|torque|threshold)$/;

export class Slider {
  /** change(value as YAML, whether it continues a movement) is called when the user moves it. */
  constructor(path, key, change) {
    this.path = path;
    this.key = key;
    const [, whole, index] = /^(.*?)(?:\[(\d+)\])?$/.exec(path);
    const name = whole.slice(whole.lastIndexOf(".") + 1);
    this.label = titleOf(whole, name, index);
    this.angle = isAngle(key);
    const unit = this.angle ? key.unit.replace("rad", "°") : key.unit === "1" ? "" : key.unit;
    const full = `${path}${unit ? `, ${unit.replace("°", "degrees")}` : ""}`;
    this.box = make("input", { type: "text", inputMode: "decimal", className: "number", "aria-label": full, autocomplete: "off" });
    this.input = make("input", { type: "range", min: 0, max: 1000, step: 1, "aria-label": full });
    this.input.dataset.path = path;
    this.element = make("div", { className: "slider", title: `${path}: ${key.description ?? ""}` },
      make("span", { className: "slider-name" }, this.label), this.input, this.box,
      make("span", { className: "unit" }, unit)); // prettier-ignore
    this.input.addEventListener("input", () => this.#move(change));
    this.input.addEventListener("change", () => (this.moving = false));
    this.box.addEventListener("change", () => this.#type(change));
  }

  /** Show the scenario's value, in SI units and radians. renewed: the range is laid around it again. */
  show(value, renewed) {
    const own = rounded(this.angle ? value / DEGREE : value, 6);
    if (own === this.value && this.range && !renewed) return;
    this.value = own;
    const outside = !this.range || own < this.range.low * (1 - 1e-9) - 1e-12 || own > this.range.high * (1 + 1e-9) + 1e-12;
    if ((renewed && !this.moving) || outside) this.range = rangeOf(this.key, value);
    if (!this.moving) this.input.value = position(this.range, own);
    if (document.activeElement !== this.box) this.box.value = String(own);
    this.input.setAttribute("aria-valuetext", `${own}${this.angle ? " degrees" : ` ${this.key.unit}`}`);
  }

  /** The text changes in the next frame, once for all movements before it. */
  #move(change) {
    if (!this.waiting) this.joined = this.moving;
    this.moving = this.waiting = true;
    const value = numberAt(this.range, Number(this.input.value));
    later(`slider-${this.path}`, () => {
      this.waiting = false;
      this.#set(value, change, this.joined);
    });
  }

  #type(change) {
    const value = Number(this.box.value.replace("−", "-").replace(",", "."));
    if (this.box.value.trim() === "" || !Number.isFinite(value)) this.box.value = String(this.value);
    else this.#set(value, change, false);
  }

  #set(value, change, joined) {
    this.value = value;
    if (document.activeElement !== this.box) this.box.value = String(value);
    change(this.angle ? `${yaml(value)} deg` : yaml(value), joined);
  }
}

function titleOf(whole, name, index) {
  const parent = whole.split(".").slice(1, -1).filter((part) => !["motion", "contact", "payload"].includes(part));
  const words = [...parent.map((part) => part.replace(/^link/, "link ")), name === "mass" && whole.includes("payload") ? "payload" : name];
  const base = words.join(" ").replaceAll("_", " ");
  if (index === undefined) return base;
  const kind = OF_JOINTS.test(name) ? "joint" : "axis";
  if (name === "q" || name === "qd") return `${name}${"₁₂₃"[index]}`;
  return `${base} ${ITEMS[3][kind][index]}`;
}
