/** One panel: its curves, the line of the present time, the values there, and the band of many runs. */
import uPlot from "uplot";
import { make } from "../app/dom.js";
import { shown } from "../app/numbers.js";
import { picked, rowAt, thin, valueOf } from "../simulate/thin.js";
import { widened } from "./beside.js";
import { drawContact } from "./contact.js";

const HEIGHT = 118;
const AXIS = 58; // px left of the curves, the same in all panels
const WIDTH = 1.7; // px, of a curve
const KEY = 18; // px, of the line of a legend: a period of all dashes
const FONT = "11px system-ui, sans-serif";

export class Plot {
  /** panel: one of panels.js. look: colours of the theme. actions: { seek(time), zoom(range or null) }. */
  constructor(panel, look, actions) {
    this.panel = panel;
    this.look = look;
    this.actions = actions;
    this.values = panel.series.map((one) => make("b", {}, ""));
    this.notes = make("span", { className: "plot-notes" });
    this.head = make("figcaption", {}, make("span", { className: "plot-title" }, `${panel.title}, ${panel.unit}`),
      ...panel.series.map((one, i) => this.#key(one, i)), this.notes); // prettier-ignore
    this.body = make("div", { className: "plot-body" });
    this.element = make("figure", { className: "plot", role: "group", "aria-label": panel.title }, this.head, this.body);
  }

  /** Draw a run. about: { spans, events }; band: quantiles of many runs, or null; range: [from, to] in s, or null; beside:
   *  curves beside its own, as of beside.js; until: the time, s, from which on the run is hidden. */
  show(run, { about, band, range, width, beside, until }) {
    Object.assign(this, { run, about, band, range, beside, until });
    this.notes.replaceChildren(...beside.map((one) => one.note()));
    this.#draw(width);
    for (const one of beside) one.put(this.plot);
  }

  #draw(width) {
    const drawn = this.#data();
    if (this.plot && this.bands === this.hasBand) {
      this.plot.setData(drawn, false);
      this.#scale();
      return;
    }
    this.plot?.destroy();
    this.bands = this.hasBand;
    this.plot = new uPlot(this.#options(width), drawn, this.body);
    this.line = make("div", { className: "now" });
    this.plot.over.append(this.line);
    this.#scale();
  }

  resize(width) {
    if (this.plot && this.plot.width !== width) this.plot.setSize({ width, height: HEIGHT });
  }

  zoom(range) {
    this.range = range;
    if (!this.plot) return;
    this.plot.setData(this.#data(), false);
    this.#scale();
  }

  /** Move the line to a time, s, and say the values there. */
  seek(time) {
    this.move(time);
    this.tell(time);
  }

  /** Move the line to a time, s. */
  move(time) {
    if (!this.plot) return;
    const x = this.plot.valToPos(time, "x");
    const inside = x >= 0 && x <= this.plot.bbox.width / devicePixelRatio; // an element's width would cost a layout
    this.line.style.transform = `translateX(${x}px)`;
    this.line.style.visibility = inside ? "" : "hidden";
  }

  /** Say the values at a time, s. */
  tell(time) {
    if (!this.plot) return;
    this.panel.series.forEach((one, i) => {
      const text = shown(this.#value(one, time));
      if (this.values[i].textContent !== text) this.values[i].textContent = text;
    });
  }

  destroy() {
    this.plot?.destroy();
    this.element.remove();
  }

  get hasBand() {
    return Boolean(this.band && this.panel.series.some((one) => one.column in this.band.columns));
  }

  #key(one, i) {
    const key = make("span", { className: "plot-key" });
    key.append(lineOf(one.look, this.look), `${one.label} `, this.values[i]);
    return key;
  }

  #value(one, time) {
    const { columns } = this.run;
    const zero = one.change ? columns[one.column][0] : 0;
    return (this.panel.scale ?? 1) * (valueOf(columns.t, columns[one.column], time) - zero);
  }

  /** Rows as uPlot takes them: times, the curves, and then of each curve the lower and the upper edge of its band. */
  #data() {
    const { columns } = this.run;
    const { t } = columns;
    const [from, last] = this.range ? [rowAt(t, this.range[0]), rowAt(t, this.range[1]) + 2] : [0, t.length];
    const to = this.until < t[t.length - 1] ? Math.min(last, rowAt(t, this.until) + 1) : last;
    const own = this.panel.series.map((one) => columns[one.column]);
    const rows = thin(own, from, Math.min(to, t.length));
    const times = picked(t, rows);
    const scale = this.panel.scale ?? 1;
    const curves = this.panel.series.map((one, i) => shifted(picked(own[i], rows, scale), one, columns, scale));
    return [times, ...curves, ...(this.hasBand ? this.#edges(times, scale) : [])];
  }

  #edges(times, scale) {
    const { time, columns } = this.band;
    return this.panel.series.flatMap((one) => {
      const found = columns[one.column];
      const zero = one.change ? this.run.columns[one.column][0] : 0;
      return ["low", "high"].map((edge) =>
        Float64Array.from(times, (t) => (found ? scale * (valueOf(time, found[edge], t) - zero) : NaN)));
    }); // prettier-ignore
  }

  #options(width) {
    const { look, panel } = this;
    const axis = { stroke: look.faint, font: FONT, grid: { stroke: look.grid, width: 1 }, ticks: { show: false } };
    const series = panel.series.map(({ look: [colour, dash, width = WIDTH] }) => ({ stroke: look[colour], width, dash, points: { show: false } }));
    const edges = this.hasBand ? series.flatMap((one) => [0, 1].map(() => ({ stroke: `${one.stroke}00`, width: 0, points: { show: false } }))) : [];
    const first = 1 + series.length;
    return {
      width, height: HEIGHT, padding: [6, 16, 0, 0], legend: { show: false }, pxAlign: false,
      cursor: { drag: { x: true, y: false, setScale: false }, points: { show: false }, y: false },
      scales: { x: { time: false }, y: { range: (_, low, high) => this.#range(...widened([low, high], this.beside)) } },
      axes: [{ ...axis, size: 22, space: 60 }, { ...axis, size: AXIS, space: 26, values: (_, ticks) => ticks.map((tick) => shownTick(tick)) }],
      series: [{}, ...series, ...edges],
      bands: this.hasBand ? series.map((one, i) => ({ series: [first + 2 * i + 1, first + 2 * i], fill: `${one.stroke}38` })) : [],
      hooks: {
        drawClear: [(plot) => drawContact(plot, { ...this.about, colour: this.look.contact, ink: this.look.faint }),
          (plot) => this.beside.forEach((one) => one.draw(plot, this.look))],
        setSelect: [(plot) => this.#selected(plot)],
        ready: [(plot) => plot.over.addEventListener("click", (event) => this.#clicked(plot, event))],
      },
    }; // prettier-ignore
  }

  #scale() {
    const { t } = this.run.columns;
    const [min, max] = this.range ?? [t[0], t[t.length - 1]];
    this.plot.setScale("x", { min, max: max > min ? max : min + 1 });
  }

  /** Keeps rounding noise on a constant line from filling the panel. */
  #range(low, high) {
    if (low === null || !Number.isFinite(low) || !Number.isFinite(high)) return [-1, 1];
    const least = this.panel.flat ?? 1e-6 * Math.max(1, Math.abs(low));
    if (high - low < least) {
      const half = this.panel.flat ? least / 2 : 1;
      return [(low + high) / 2 - half, (low + high) / 2 + half];
    }
    const margin = 0.07 * (high - low);
    return [low - margin, high + margin];
  }

  #selected(plot) {
    const { left, width } = plot.select;
    if (width < 4) return;
    const range = [plot.posToVal(left, "x"), plot.posToVal(left + width, "x")];
    plot.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
    this.dragged = true;
    this.actions.zoom(range);
  }

  #clicked(plot, event) {
    if (!this.dragged) this.actions.seek(plot.posToVal(event.offsetX, "x"));
    this.dragged = false;
  }
}

/** The line that a legend shows for a curve: in its colour, with its dashes. */
function lineOf([colour, dash, width = WIDTH], look) {
  const line = drawing("svg", { class: "plot-line", width: KEY, height: 4, "aria-hidden": "true" });
  line.append(drawing("path", { d: `M0 2H${KEY}`, stroke: look[colour], "stroke-width": width, "stroke-dasharray": dash.join(" ") }));
  return line;
}

function drawing(tag, attributes) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return element;
}

function shifted(values, one, columns, scale) {
  if (!one.change) return values;
  const zero = scale * columns[one.column][0];
  return values.map((value) => value - zero);
}

function shownTick(tick) {
  const size = Math.abs(tick);
  const text = size !== 0 && (size < 1e-3 || size >= 1e5) ? tick.toExponential(0) : String(Number(tick.toPrecision(6)));
  return text.replaceAll("-", "−").replace("e+", "e");
}
