/** The energies at the present time as bars over the scene: the terms of the balance, on one scale for the whole run. */
import { colours } from "../app/colours.js";
import { at, make } from "../app/dom.js";
import { later, show } from "../app/frames.js";
import { READABLE, fixed } from "../app/numbers.js";
import { seriesOf } from "../plots/panels.js";
import { valueOf } from "../simulate/thin.js";

const DIGITS = 3; // of the largest number
const LEAST = -1; // exponent of a number that has as many digits behind the point as there is room for

export class EnergyBars {
  constructor(store) {
    this.store = store;
    this.bars = [];
    this.told = -Infinity; // when the numbers were last said, ms
    store.on(["run", "theme", "energies"], () => later("energies", () => this.#show()));
    store.on(["time", "playing"], () => show("energies", () => this.#draw()));
  }

  #show() {
    const run = this.store.get("run");
    const series = run && this.store.get("energies") ? seriesOf("energies", run.columns) : [];
    const look = colours(this.store.get("theme"));
    const key = JSON.stringify([series, look]);
    if (key !== this.key) this.bars = series.map((one) => barOf(one, look));
    if (key !== this.key) at("energy-bars").replaceChildren(...this.bars.map(({ row }) => row));
    this.key = key;
    at("energies").hidden = series.length === 0;
    if (series.length > 0) this.#fit(run.columns);
    this.told = -Infinity;
    this.#draw();
  }

  /** Lay the scale around all values of the run, and around zero. */
  #fit(columns) {
    let [low, high] = [0, 1e-9];
    for (const bar of this.bars) {
      bar.values = columns[bar.column];
      bar.zero = bar.change ? bar.values[0] : 0;
      for (const value of bar.values) {
        low = Math.min(low, value - bar.zero);
        high = Math.max(high, value - bar.zero);
      }
    }
    this.times = columns.t;
    this.span = high - low;
    this.digits = Math.max(0, DIGITS - Math.max(LEAST, Math.ceil(Math.log10(this.span))));
    for (const { fill } of this.bars) fill.style.left = `${(-100 * low) / this.span}%`;
  }

  #draw() {
    if (at("energies").hidden) return;
    const time = this.store.get("time");
    const values = this.bars.map(({ values: column, zero }) => valueOf(this.times, column, time) - zero);
    this.bars.forEach(({ fill }, i) => (fill.style.transform = `scaleX(${values[i] / this.span})`));
    if (this.store.get("playing") && performance.now() - this.told < READABLE) return;
    this.told = performance.now();
    this.bars.forEach(({ number }, i) => (number.textContent = fixed(values[i], this.digits)));
  }
}

function barOf({ column, label, look: [colour], change }, look) {
  const fill = make("i");
  fill.style.background = look[colour];
  const number = make("b");
  const row = make("li", {}, make("span", {}, label), make("span", { className: "energy-bar", "aria-hidden": "true" }, fill), number);
  return { column, change, fill, number, row };
}
