/** All panels over one axis of time: chosen by name, zoomed together, with one line for the present time. */
import { at, make } from "../app/dom.js";
import { colours } from "../app/colours.js";
import { later, show } from "../app/frames.js";
import { READABLE } from "../app/numbers.js";
import { measuredIn } from "../measured/curves.js";
import { contactSpans } from "./contact.js";
import { panelsOf } from "./panels.js";
import { Plot } from "./plot.js";

export class Plots {
  #plots = new Map();
  #told = -Infinity; // when the values were last said, ms

  constructor(store) {
    this.store = store;
    this.list = at("plots");
    this.choice = at("plot-choice");
    store.on(["run", "chosenPlots"], () => later("plots", () => this.#show()));
    store.on(["bandRun", "guess", "measured"], () => later("plots-redraw", () => this.#redraw()));
    store.on(["theme"], () => later("plots", () => this.#renew()));
    store.on(["time", "playing"], () => show("plots", () => this.#seek()));
    store.on(["range"], () => this.#zoom());
    store.on(["degrees"], () => later("plots", () => this.#renew()));
    new ResizeObserver(() => later("plot-size", () => this.#resize())).observe(this.list);
    at("zoom-in").addEventListener("click", () => this.magnify(0.5));
    at("zoom-out").addEventListener("click", () => this.magnify(2));
    at("zoom-all").addEventListener("click", () => store.set({ range: null }));
    this.list.addEventListener("dblclick", () => store.set({ range: null }));
  }

  /** Show a part of the time that is `factor` times as long, around the present time. */
  magnify(factor) {
    const { t } = this.store.get("run").columns;
    const [first, last] = [t[0], t[t.length - 1]];
    const [from, to] = this.store.get("range") ?? [first, last];
    const time = Math.min(to, Math.max(from, this.store.get("time")));
    const start = Math.max(first, time - factor * (time - from));
    const end = Math.min(last, time + factor * (to - time));
    if (end - start < 1e-9 * (last - first)) return;
    this.store.set({ range: start <= first && end >= last ? null : [start, end] });
  }

  /** The panels as canvases, from the top down. */
  pictures() {
    return [...this.#plots.values()].filter((one) => one.plot).map((one) => [one.panel, one.plot.ctx.canvas]);
  }

  #show() {
    const run = this.store.get("run");
    if (!run) return;
    const { t } = run.columns;
    const range = this.store.get("range");
    if (range && (range[0] >= t[t.length - 1] || range[1] <= t[0])) this.store.set({ range: null });
    const all = panelsOf(run, this.store.get("degrees"));
    const chosen = this.store.get("chosenPlots");
    const wanted = all.filter((panel) => chosen[panel.name] ?? panel.first);
    this.#offer(all, wanted);
    this.#keep(wanted);
    this.run = run;
    this.#redraw();
    this.store.set({ panels: wanted });
  }

  #redraw() {
    for (const plot of this.#plots.values()) later(`plot-${plot.panel.name}`, () => this.#draw(plot));
  }

  #draw(plot) {
    if (!plot.element.isConnected) return;
    const range = this.store.get("range");
    const band = this.store.get("bandRun");
    plot.show(this.run, { band, range, width: this.list.clientWidth, ...this.#beside(plot.panel) });
    plot.seek(this.store.get("time"));
  }

  /** What stands beside the curves of a panel, and until when run and contact are shown. */
  #beside(panel) {
    const guess = this.store.get("guess");
    const until = guess && !guess.seen ? guess.curve.from : Infinity;
    const spans = contactSpans(this.run).filter(([start]) => start < until).map(([start, end]) => [start, Math.min(end, until)]);
    const about = { spans, events: this.run.events.filter((event) => event.t <= until) };
    const drawn = guess?.panel === panel.name ? [guess.pad] : [];
    const measured = until < Infinity ? [] : measuredIn(panel, this.store.get("measured"), this.run);
    const beside = [...measured, ...drawn];
    return { about, beside, until };
  }

  /** Keep the panels that are still wanted, in order; make what is new; take away the others. */
  #keep(wanted) {
    const look = colours(this.store.get("theme"));
    const kept = new Map();
    for (const panel of wanted) {
      const key = panel.name + panel.series.map((one) => one.column).join();
      const plot = this.#plots.get(key) ?? new Plot(panel, look, this.#actions);
      this.#plots.delete(key);
      kept.set(key, plot);
    }
    for (const plot of this.#plots.values()) plot.destroy();
    this.#plots = kept;
    [...kept.values()].forEach(({ element }, i) => {
      if (this.list.children[i] !== element) this.list.insertBefore(element, this.list.children[i] ?? null);
    });
  }

  #offer(all, wanted) {
    const key = all.map((panel) => panel.name).join() + wanted.map((panel) => panel.name).join();
    if (key === this.offered) return;
    this.offered = key;
    this.choice.replaceChildren(...all.map((panel) => {
      const box = make("input", { type: "checkbox", checked: wanted.includes(panel) });
      box.addEventListener("change", () =>
        this.store.set({ chosenPlots: { ...this.store.get("chosenPlots"), [panel.name]: box.checked } }));
      return make("label", {}, box, ` ${panel.title}`);
    })); // prettier-ignore
  }

  #actions = {
    seek: (time) => this.store.set({ time: this.#inside(time), playing: false }),
    zoom: (range) => this.store.set({ range }),
  };

  #inside(time) {
    const { t } = this.store.get("run").columns;
    return Math.min(t[t.length - 1], Math.max(t[0], time));
  }

  #renew() {
    for (const plot of this.#plots.values()) plot.destroy();
    this.#plots = new Map();
    this.#show();
  }

  #zoom() {
    for (const plot of this.#plots.values()) {
      later(`plot-${plot.panel.name}`, () => {
        plot.zoom(this.store.get("range"));
        plot.seek(this.store.get("time"));
      });
    }
  }

  #seek() {
    const time = this.store.get("time");
    for (const plot of this.#plots.values()) plot.move(time);
    if (this.store.get("playing") && performance.now() - this.#told < READABLE) return;
    this.#told = performance.now();
    for (const plot of this.#plots.values()) plot.tell(time);
  }

  #resize() {
    for (const plot of this.#plots.values()) {
      later(`size-${plot.panel.name}`, () => {
        plot.resize(this.list.clientWidth);
        plot.seek(this.store.get("time"));
      });
    }
  }
}
