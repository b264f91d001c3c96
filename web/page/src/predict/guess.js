/** A curve that somebody draws before the run is shown: values at evenly spaced times, straight between them. */

const KNOTS = 25;
const TOUCH = 0.02; // a share of the largest force below which a drawn force is none

export class Guess {
  /** column: what is drawn, in its unit. from, to: s. low, high: between which a curve can be drawn. start: its first value. */
  constructor({ column, from, to, low, high, start }) {
    Object.assign(this, { column, low, high });
    this.times = Float64Array.from({ length: KNOTS }, (_, i) => from + (i / (KNOTS - 1)) * (to - from));
    this.values = new Float64Array(KNOTS).fill(start);
  }

  get from() {
    return this.times[0];
  }

  get to() {
    return this.times[KNOTS - 1];
  }

  /** The number of the knot next to a time, s. */
  nearest(time) {
    const place = Math.round(((KNOTS - 1) * (time - this.from)) / (this.to - this.from));
    return Math.min(KNOTS - 1, Math.max(0, place));
  }

  /** Draw from one point to another, each { time, value }. */
  stroke(one, other) {
    const [a, b] = [this.nearest(one.time), this.nearest(other.time)];
    const step = Math.sign(b - a);
    for (let i = a; i !== b; i += step) {
      this.values[i] = this.#inside(one.value + ((i - a) / (b - a)) * (other.value - one.value));
    }
    this.values[b] = this.#inside(other.value);
  }

  /** Move the curve from a knot on to a value. */
  hold(knot, value) {
    this.values.fill(this.#inside(value), knot);
  }

  at(time) {
    const place = ((KNOTS - 1) * (time - this.from)) / (this.to - this.from);
    const i = Math.min(KNOTS - 2, Math.max(0, Math.floor(place)));
    return this.values[i] + (place - i) * (this.values[i + 1] - this.values[i]);
  }

  /** How far a run is from the curve: { mean: root of the mean square, most, when: s }, in the unit of the column. */
  distance({ t, [this.column]: column }) {
    let [squares, length, most, when] = [0, 0, 0, this.from];
    for (let i = 1; i < t.length; i += 1) {
      if (t[i] < this.from || t[i] > this.to) continue;
      const off = Math.abs(column[i] - this.at(t[i]));
      squares += off * off * (t[i] - t[i - 1]);
      length += t[i] - t[i - 1];
      if (off > most) [most, when] = [off, t[i]];
    }
    return { mean: Math.sqrt(squares / (length || 1)), most, when };
  }

  /** How often the curve, of a force, rises from none. */
  contacts() {
    const least = TOUCH * Math.max(...this.values.map(Math.abs));
    const touches = [...this.values].map((value) => Math.abs(value) > least);
    return touches.filter((one, i) => one && !touches[i - 1]).length;
  }

  #inside(value) {
    return Math.min(this.high, Math.max(this.low, value));
  }
}
