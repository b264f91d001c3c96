/** Play, scrub and speed: the present time of the run. */
import { at } from "../app/dom.js";
import { show } from "../app/frames.js";
import { shown } from "../app/numbers.js";

const STEPS = 10_000; // positions of the scrubber
const LEAD = 1; // s of watching before what is to be watched
const LONGEST = 0.25; // s of a frame: a page that was hidden goes on where it was
const STILL = matchMedia("(prefers-reduced-motion: reduce)");
const ICONS = { play: "M7 4l13 8-13 8z", pause: "M6 4h4v16H6zM14 4h4v16h-4z" };

export class Transport {
  constructor(store) {
    this.store = store;
    this.scrubber = at("scrubber");
    this.scrubber.max = STEPS;
    at("play").addEventListener("click", () => this.toggle());
    at("to-start").addEventListener("click", () => this.seek(this.span[0]));
    at("to-end").addEventListener("click", () => this.seek(this.span[1]));
    at("speed").addEventListener("change", (event) => store.set({ speed: Number(event.target.value) }));
    this.scrubber.addEventListener("input", () => this.#scrubbed());
    store.on(["opened"], () => this.replay());
    store.on(["run"], () => this.#fit());
    store.on(["time", "run"], () => show("transport", () => this.#show()));
    store.on(["playing"], () => this.#play());
    store.on(["speed"], () => (at("speed").value = String(store.get("speed"))));
  }

  get span() {
    const { t } = this.store.get("run")?.columns ?? { t: [0] };
    return [t[0], t[t.length - 1]];
  }

  toggle() {
    const [start, end] = this.span;
    if (!this.store.get("playing") && this.store.get("time") >= end) this.store.set({ time: start });
    this.store.set({ playing: !this.store.get("playing") });
  }

  /** Play the run of the present text, as soon as it is there, from just before what is to be watched; speed: null for
   *  one at which it can be watched. Where the system asks for less motion, its moment is shown. */
  replay(speed = null) {
    this.waiting = { speed };
    this.#fit();
  }

  /** Go to a time, s, and stay there. */
  seek(time) {
    const [start, end] = this.span;
    this.store.set({ time: this.#inside(time, start, end), playing: false });
  }

  /** Go so many hundredths of the run on, or back. */
  step(hundredths) {
    const [start, end] = this.span;
    this.seek(this.store.get("time") + (hundredths * (end - start)) / 100);
  }

  /** Play this many places of the list faster, or slower. */
  change(places) {
    const speeds = [...at("speed").options].map((option) => Number(option.value));
    const now = speeds.indexOf(this.store.get("speed"));
    this.store.set({ speed: speeds[Math.min(speeds.length - 1, Math.max(0, now + places))] });
  }

  /** The speed at which what lasts so long, s, can be watched: what is short is slowed down. */
  #watchable(length) {
    const speeds = [...at("speed").options].map((option) => Number(option.value));
    return speeds.filter((speed) => speed <= Math.min(1, length / 3)).at(-1) ?? speeds[0];
  }

  #inside(time, start, end) {
    return Math.min(end, Math.max(start, time));
  }

  #scrubbed() {
    const [start, end] = this.span;
    this.store.set({ time: start + ((end - start) * this.scrubber.value) / STEPS, playing: false });
  }

  #fit() {
    const [start, end] = this.span;
    if (this.waiting && this.store.get("run")?.text === this.store.get("text")) this.#begin(start, end);
    else this.store.set({ time: this.#inside(this.store.get("time"), start, end) });
  }

  /** Time waits until all of the run is drawn. */
  #begin(start, end) {
    const { begins, lasts, moment } = this.store.get("run").watch;
    const speed = this.waiting.speed ?? this.#watchable(lasts);
    this.waiting = null;
    this.opening = true;
    const time = STILL.matches ? moment : begins - LEAD * speed;
    this.store.set({ time: this.#inside(time, start, end), speed, playing: !STILL.matches });
  }

  #show() {
    const [start, end] = this.span;
    const time = this.store.get("time");
    this.scrubber.value = end > start ? Math.round((STEPS * (time - start)) / (end - start)) : 0;
    const digits = end - start < 0.1 ? 5 : 3;
    at("time").textContent = `${time.toFixed(digits)} s`;
    this.scrubber.setAttribute("aria-valuetext", `${shown(time)} seconds of ${shown(end)}`);
  }

  #play() {
    const playing = this.store.get("playing");
    at("play").setAttribute("aria-label", playing ? "Pause" : "Play");
    at("play").querySelector("path").setAttribute("d", playing ? ICONS.pause : ICONS.play);
    if (!playing || this.running) return;
    this.running = true;
    this.last = performance.now();
    requestAnimationFrame((now) => this.#frame(now));
  }

  #frame(now) {
    if (!this.store.get("playing")) {
      this.running = false;
      return;
    }
    const [start, end] = this.span;
    this.opening &&= "drawing" in document.body.dataset;
    const passed = this.opening ? 0 : Math.min(LONGEST, (now - this.last) / 1000);
    const time = this.store.get("time") + passed * this.store.get("speed");
    this.last = now;
    this.store.set({ time: this.#inside(time, start, end), playing: time < end });
    requestAnimationFrame((next) => this.#frame(next));
  }
}
