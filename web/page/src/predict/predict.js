/** Predict, then run: a curve is drawn before the run is shown, and then both, with the distance between them. */
import { at, make } from "../app/dom.js";
import { shown } from "../app/numbers.js";
import { contactSpans } from "../plots/contact.js";
import { panelsOf } from "../plots/panels.js";
import { rowAt, valueOf } from "../simulate/thin.js";
import { Guess } from "./guess.js";
import { Pad } from "./pad.js";

const ROOM = 1.4; // of a panel, over what the run needs: its height shall not tell the run
const AFTER = 0.25; // how long after what is to be watched, as a share of it

export class Predict {
  constructor(store, transport) {
    Object.assign(this, { store, transport });
    at("predict-start").addEventListener("click", () => (store.get("guess") ? this.end() : this.start()));
    at("predict-end").addEventListener("click", () => this.end());
    at("predict-see").addEventListener("click", () => (store.get("guess").seen ? this.start(this.asked) : this.#see()));
    at("predict-curve").addEventListener("change", (event) => this.start({ ...this.asked, column: event.target.value }));
    store.on(["opened", "degrees"], () => this.end());
    store.on(["run"], () => this.#arrived());
  }

  /**
   * Let a curve be drawn, as soon as the run of the present text is there.
   *
   * column: null for the one of the sentence that says what to watch. question: before it is drawn. done(): called when
   * the run is seen.
   */
  start({ column = null, question = "What will happen?", done = () => {} } = {}) {
    this.asked = { column, question, done };
    this.store.set({ playing: false });
    this.waiting = true;
    this.#arrived();
  }

  /** Take the curve away, and show the run. */
  end() {
    this.waiting = false;
    if (!this.store.get("guess")) return;
    this.#show(null);
    this.store.set({ guess: null, range: null });
  }

  #arrived() {
    const run = this.store.get("run");
    const guess = this.store.get("guess");
    if (this.waiting && run?.text === this.store.get("text")) this.#begin(run);
    else if (guess?.seen) at("predict-say").textContent = verdict(guess, run);
  }

  #begin(run) {
    this.waiting = false;
    const panels = panelsOf(run, this.store.get("degrees")).map(foreseeable).filter(({ series }) => series.length > 0);
    const { panel, series } = found(panels, this.asked.column ?? run.watch.column) ?? found(panels, panels[0].series[0].column);
    const curve = guessOf(run, series.column);
    const about = { unit: panel.unit, scale: panel.scale ?? 1, label: labelOf(panel, series) };
    const pad = new Pad(curve, { ...about, done: () => this.#see() });
    const before = AFTER * (curve.to - curve.from);
    this.store.set({
      guess: { ...about, curve, pad, panel: panel.name, column: series.column, seen: false },
      range: [Math.max(run.columns.t[0], curve.from - before), curve.to],
      time: curve.from, playing: false, tab: "plots", chosenPlots: { ...this.store.get("chosenPlots"), [panel.name]: true },
    }); // prettier-ignore
    at("predict-curve").replaceChildren(...panels.flatMap((one) => one.series.map((own) => make("option", { value: own.column }, labelOf(one, own)))));
    at("predict-curve").value = series.column;
    at("predict-say").textContent = `${this.asked.question} Draw it in the panel “${panel.title}”, from ${shown(curve.from, 3)} s on.`;
    this.#show("drawing");
  }

  #see() {
    const guess = { ...this.store.get("guess"), seen: true };
    guess.pad.close();
    this.store.set({ guess });
    at("predict-say").textContent = verdict(guess, this.store.get("run"));
    this.#show("seen");
    this.transport.replay();
    this.asked.done();
  }

  /** state: "drawing", "seen", or null. */
  #show(state) {
    at("predict").hidden = state === null;
    at("predict-start").setAttribute("aria-pressed", String(state !== null));
    at("predict-see").textContent = state === "seen" ? "Draw again" : "See it";
    document.body.classList.toggle("predicting", state === "drawing");
  }
}

/** A panel without what is wanted or measured. */
function foreseeable(panel) {
  return { ...panel, series: panel.series.filter(({ column }) => !/_(ref|measured)/.test(column)) };
}

function found(panels, column) {
  const panel = panels.find((one) => one.series.some((own) => own.column === column));
  return panel && { panel, series: panel.series.find((own) => own.column === column) };
}

function labelOf(panel, series) {
  return panel.series.length > 1 ? `${panel.title}, ${series.label}` : panel.title;
}

/** A curve to draw from, where what is to be watched begins: level, as high as the run is there. */
function guessOf({ columns, watch }, column) {
  const { t } = columns;
  const values = columns[column];
  const from = watch.begins;
  const to = Math.min(t[t.length - 1], from + (1 + AFTER) * watch.lasts);
  const start = valueOf(t, values, from);
  const part = values.subarray(rowAt(t, from), rowAt(t, to) + 1);
  let [least, most] = [start, start];
  for (const value of part) [least, most] = [Math.min(least, value), Math.max(most, value)];
  const reach = niceAbove(ROOM * Math.max(most - start, start - least));
  const low = least >= 0 && start <= 0.5 * most ? 0 : start - reach;
  return new Guess({ column, from, to, low, high: start + reach, start });
}

/** The next number 1, 2 or 5 times a power of ten; 1 for nothing. */
function niceAbove(size) {
  if (size < 1e-12) return 1;
  const power = 10 ** Math.floor(Math.log10(size));
  return [1, 2, 5, 10].map((digit) => digit * power).find((value) => value >= size);
}

function verdict({ curve, unit, scale, column }, run) {
  if (!(column in run.columns)) return "This run has no such curve.";
  const { mean, most, when } = curve.distance(run.columns);
  const far = `Your curve is ${shown(scale * mean, 3)} ${unit} from the run (root mean square), at most ${shown(scale * most, 3)} ${unit}, at ${shown(when, 3)} s.`;
  if (column !== "force") return far;
  const own = curve.contacts();
  return `${far} You drew ${own} ${own === 1 ? "contact" : "contacts"}; the run has ${contactSpans(run).length}.`;
}
