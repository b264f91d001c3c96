/** Where a curve is drawn: over a panel, by mouse, finger or keys. */
import { make } from "../app/dom.js";
import { shown } from "../app/numbers.js";
import { drawCurve } from "../plots/beside.js";

const FINE = 0.02; // of the height, for a press of a key; with Shift five times as much

export class Pad {
  /**
   * curve: a Guess. unit, scale, label: of its panel and series. done(): called where Enter says that the curve is drawn.
   * A plot shows it as a curve beside its own.
   */
  constructor(curve, { unit, scale, label, done }) {
    Object.assign(this, { curve, unit, scale, knot: 0, open: true });
    this.element = make("div", { className: "pad", role: "slider", tabIndex: 0, "aria-orientation": "vertical",
      "aria-label": `Your curve of ${label}, ${unit}: left and right choose a time, up and down move the curve from there on` }); // prettier-ignore
    this.keys = {
      ArrowLeft: () => this.#choose(this.knot - 1),
      ArrowRight: () => this.#choose(this.knot + 1),
      ArrowUp: (event) => this.#lift(event.shiftKey ? 5 : 1),
      ArrowDown: (event) => this.#lift(event.shiftKey ? -5 : -1),
      Home: () => this.#choose(0),
      End: () => this.#choose(this.curve.times.length - 1),
      Enter: done,
    };
    this.element.addEventListener("keydown", (event) => this.#pressed(event));
    for (const kind of ["mousedown", "mousemove", "mouseup", "click", "dblclick"]) {
      this.element.addEventListener(kind, (event) => event.stopPropagation()); // the plot would zoom
    }
    this.element.addEventListener("pointerdown", (event) => this.#down(event));
    this.element.addEventListener("pointermove", (event) => this.#move(event));
    this.element.addEventListener("pointerup", () => (this.last = null));
    this.#tell();
  }

  get low() {
    return this.scale * this.curve.low;
  }

  get high() {
    return this.scale * this.curve.high;
  }

  /** Take the place over a plot. */
  put(plot) {
    const first = !this.plot;
    this.plot = plot;
    if (!this.open) return;
    plot.over.append(this.element);
    if (first) this.element.focus({ preventScroll: true });
  }

  /** The curve stays as it is from now on. */
  close() {
    this.open = false;
    this.element.remove();
  }

  draw(plot, look) {
    const values = this.curve.values.map((value) => this.scale * value);
    drawCurve(plot, this.curve.times, values, { colour: look.faint, width: 3 });
    if (!this.open) return;
    const [time, value] = [this.curve.times[this.knot], values[this.knot]];
    drawCurve(plot, [time, time], [value, value], { colour: look.ink, width: 8 }); // a dot
  }

  /** What stands for the curve beside the names of the others. */
  note() {
    return make("span", { className: "yours" }, "yours");
  }

  #down(event) {
    this.element.setPointerCapture(event.pointerId);
    this.last = this.#point(event);
    this.#stroke(this.last);
  }

  #move(event) {
    if (this.last) this.#stroke(this.#point(event));
  }

  #stroke(point) {
    this.curve.stroke(this.last, point);
    this.last = point;
    this.#choose(this.curve.nearest(point.time));
  }

  #point(event) {
    const { left, top } = this.element.getBoundingClientRect();
    const time = this.plot.posToVal(event.clientX - left, "x");
    return { time, value: this.plot.posToVal(event.clientY - top, "y") / this.scale };
  }

  #pressed(event) {
    const act = this.keys[event.key];
    if (!act) return;
    event.preventDefault();
    event.stopPropagation(); // the page's own keys
    act(event);
  }

  #choose(knot) {
    this.knot = Math.min(this.curve.times.length - 1, Math.max(0, knot));
    this.#changed();
  }

  #lift(steps) {
    const { low, high, values } = this.curve;
    this.curve.hold(this.knot, values[this.knot] + steps * FINE * (high - low));
    this.#changed();
  }

  #changed() {
    this.#tell();
    this.plot?.redraw(false);
  }

  #tell() {
    const value = this.scale * this.curve.values[this.knot];
    const said = { min: this.low, max: this.high, now: value, text: `${shown(value)} ${this.unit} at ${shown(this.curve.times[this.knot])} s` };
    for (const [name, text] of Object.entries(said)) this.element.setAttribute(`aria-value${name}`, text);
  }
}
