/** What was measured, in a panel: broad and pale behind the curves of the run, as in the figures. */
import { make } from "../app/dom.js";
import { shown } from "../app/numbers.js";
import { drawCurve } from "../plots/beside.js";
import { picked, rowAt, thin } from "../simulate/thin.js";

const PALE = "59"; // opacity, hexadecimal

/** The measured curves of a panel, as a list of one or of none. log: as readLog gives it, or null. */
export function measuredIn(panel, log, run) {
  const series = panel.series.filter((one) => log && one.column in log.columns);
  return series.length > 0 ? [new MeasuredCurves(panel, series, log, run)] : [];
}

class MeasuredCurves {
  constructor(panel, series, log, run) {
    Object.assign(this, { panel, log, scale: panel.scale ?? 1 });
    this.curves = series.map((one) => this.#curve(one, log, run));
    const all = this.curves.flatMap(({ values }) => [least(values), -least(values.map((value) => -value))]);
    [this.low, this.high] = [Math.min(...all), Math.max(...all)];
  }

  /** In the unit of the panel; off: how far the run is from it, root of the mean square. */
  #curve(one, { columns }, run) {
    const { t, values: measured } = columns[one.column];
    const own = run.columns[one.column];
    const zero = one.change ? own[0] : 0;
    const values = measured.map((value) => this.scale * (value - zero));
    return { look: one.look, times: t, values, off: this.scale * distance(measured, t, own, run.columns.t) };
  }

  put() {}

  draw(plot, look) {
    const { min, max } = plot.scales.x;
    for (const { times, values, look: own } of this.curves) {
      if (times.length === 0) continue;
      const rows = thin([values], rowAt(times, min), Math.min(times.length, rowAt(times, max) + 2));
      drawCurve(plot, picked(times, rows), picked(values, rows), { colour: look[own[0]] + PALE, width: 4.5 });
    }
  }

  note() {
    const off = this.curves.map((one) => (Number.isNaN(one.off) ? "at other times" : shown(one.off, 3))).join(", ");
    return make("span", { className: "measured-note", title: "root of the mean square, where both have rows" }, `${this.log.name} (broad): off by ${off} ${this.panel.unit}`);
  }
}

/** Root of the mean square of what is between a measurement and a run, at the times of both; NaN where there are none. */
function distance(measured, times, column, t) {
  let [squares, count, i] = [0, 0, 0];
  for (let k = 0; k < times.length; k += 1) {
    if (times[k] < t[0] || times[k] > t[t.length - 1]) continue;
    while (i < t.length - 2 && t[i + 1] <= times[k]) i += 1;
    const share = Math.min(1, (times[k] - t[i]) / (t[i + 1] - t[i]));
    squares += (measured[k] - column[i] - share * (column[i + 1] - column[i])) ** 2;
    count += 1;
  }
  return Math.sqrt(squares / count);
}

function least(values) {
  return values.reduce((a, b) => Math.min(a, b), Infinity);
}
