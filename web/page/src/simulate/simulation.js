/** From the text in the store to results in the store: every change of the text runs the whole scenario again. */
import { given } from "../app/given.js";
import { Runner } from "./runner.js";
import { source } from "./source.js";

const QUIET = 150; // ms without a change after which a band of runs is asked for
const RUNS = 1000;

export class Simulation {
  #store;
  #runner;
  #waiting = 0;
  #changed = false;
  #promises = new Map(); // of the questions whose answer is waited for, by id

  constructor(store) {
    this.#store = store;
    store.on(["text"], () => this.#ask());
    store.on(["band", "panels"], () => this.#askForBand()); // each run brings its panels
  }

  /** Load the simulator. Throws an Error where it cannot be loaded. */
  async start() {
    const { wasm, makeWorker } = await source();
    this.#runner = new Runner(makeWorker, wasm, (message) => this.#answers[message.kind](message));
    this.#ask();
  }

  /** The run of the present text as CSV. */
  csv() {
    return this.#wait("csv", {});
  }

  /** The text with another choice (YAML) at a path, without the keys of the old one; `needed`: keys it must have. */
  choose(path, value, needed) {
    this.#store.set({ busy: true });
    return this.#wait("choose", { path, value, needed });
  }

  /** The pose { q, tip } that brings the tip to a point, m, or as near as it reaches; null where there is none. */
  pose(point) {
    this.#store.set({ busy: true });
    return this.#wait("pose", { point, near: this.#store.get("resolved").initial.q });
  }

  #wait(kind, question) {
    return new Promise((resolve, reject) => {
      this.#promises.set(this.#runner.ask({ kind, ...this.#scenario(), ...question }), { resolve, reject });
    });
  }

  /** The promise of a question that is answered. Older ones have been given up: nothing is kept for them. */
  #promiseOf(id) {
    const promise = this.#promises.get(id);
    for (const asked of this.#promises.keys()) if (asked <= id) this.#promises.delete(asked);
    return promise;
  }

  #scenario() {
    return { text: this.#store.get("text"), name: `${this.#store.get("name")}.yaml` };
  }

  #ask() {
    if (!this.#runner || this.#isRecorded()) return;
    this.#changed = true;
    this.#store.set({ busy: true });
    this.#runner.ask({ kind: "run", ...this.#scenario() });
  }

  /** Whether the run that the page was given is shown, and nothing has been changed since. */
  #isRecorded() {
    const run = this.#store.get("run");
    return !this.#changed && Boolean(run?.recorded) && run.text === this.#store.get("text");
  }

  #askForBand() {
    clearTimeout(this.#waiting);
    const { within, keys } = this.#store.get("band");
    if (!within) return this.#store.set({ bandRun: null });
    this.#waiting = setTimeout(() => {
      const run = this.#store.get("run");
      if (!run || run.text !== this.#store.get("text")) return; // another run is coming
      if (this.#runner.busy) return void this.#askForBand(); // a file, or a band that is no longer wanted
      const shown = this.#store.get("panels").flatMap((panel) => panel.series.map((one) => one.column));
      const columns = shown.filter((column) => column in run.columns);
      const options = { runs: RUNS, seed: 1, columns, within: Object.fromEntries(keys.map((key) => [key, within])) };
      this.#store.set({ busy: true });
      this.#runner.ask({ kind: "band", ...this.#scenario(), options });
    }, QUIET);
    return undefined;
  }

  #answers = {
    loaded: ({ version, schema }) => {
      if (!this.#store.get("schema")) this.#store.set({ version, schema: JSON.parse(schema) });
    },
    read: ({ text, problems, warnings, resolved }) => {
      this.#store.set({ problems, warnings, checked: text, ...(resolved ? { resolved } : { busy: false }) });
    },
    run: ({ run, text }) => this.#store.set({ run: { ...run, text }, failure: "", busy: false, bandRun: null }),
    band: ({ band, text, last }) => {
      if (text === this.#store.get("text")) this.#store.set({ bandRun: band, busy: !last });
    },
    chosen: ({ id, text }) => {
      this.#promiseOf(id).resolve(text);
      this.#store.set({ busy: text !== this.#store.get("text") });
    },
    pose: ({ id, pose }) => {
      this.#store.set({ busy: false });
      this.#promiseOf(id).resolve(pose);
    },
    csv: ({ id, csv }) => this.#promiseOf(id).resolve(csv),
    failed: ({ message, problems, question }) => {
      this.#promiseOf(question?.id)?.reject(new Error(message));
      const isOfText = question?.kind !== "band"; // of a text that was read and run before
      this.#store.set({ failure: message, busy: false, ...(isOfText ? { problems } : {}) });
    },
  };
}

/** What stands beside the page's HTML about the build: the scenarios by name, in the menu's order. */
export async function shippedScenarios() {
  return given("arm3r-examples") ?? (await fetch("examples.json")).json();
}
