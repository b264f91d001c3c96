/**
 * The worker that holds the simulator. It answers one question at a time; a page with a newer one ends the worker.
 *
 * In:  { kind: "load", wasm } with the bytes of arm3r.wasm, or the module that another worker compiled; then
 *      { kind: "run" | "band" | "choose" | "pose" | "csv", id, text, name, ... }.
 * Out: { kind: "loaded", module, version, schema }, then the answers, each with the id of its question.
 */
import { load } from "../../../core/core.js";
import { poseTowards } from "./reach.js";
import { changed, removing, setting } from "../scenario/edit.js";
import { watchOf } from "../watch/moments.js";

const ALL_COLUMNS = { "time.log_columns": "null" }; // what is drawn, whatever the log is to have
const MOST_ROUNDS = 8; // of taking out keys that belong to the choice before
const BAND_ROUNDS = [40, 200]; // runs of a band that are shown before all are there
const BAND_ROWS = 201;
const [LOW, HIGH] = [0.05, 0.95]; // quantiles between which a band lies

let core = null;

const answers = {
  async load({ wasm }) {
    core = await load(wasm);
    post({ kind: "loaded", module: core.module, version: core.version, schema: core.schema() });
  },

  run({ id, text, name }) {
    const { problems, warnings, resolved } = core.read(text, { name });
    post({ kind: "read", id, text, problems, warnings, resolved });
    if (!resolved) return;
    const start = performance.now();
    const { events, summary, checks, report, ...own } = core.run(text, { name });
    const { columns, units } = resolved.time.log_columns ? core.run(text, { name, set: ALL_COLUMNS }) : own;
    const { q1, q2, q3, t } = columns;
    const angles = Float64Array.from({ length: 3 * t.length }, (_, i) => [q1, q2, q3][i % 3][(i / 3) | 0]);
    const arm = core.positions(text, angles, { name });
    const run = { columns, units, events, summary, checks, report, resolved, arm, name: summary.name };
    run.milliseconds = performance.now() - start;
    run.watch = watchOf(run);
    const moved = [...Object.values(columns), arm.points, arm.axes];
    post({ kind: "run", id, text, run }, moved.map((numbers) => numbers.buffer)); // prettier-ignore
  },

  band({ id, text, name, options }) {
    const start = performance.now();
    for (const runs of [...BAND_ROUNDS.filter((some) => some < options.runs), options.runs]) {
      const { time, quantiles } = core.batch(text, { ...options, name, runs, rows: BAND_ROWS, levels: [LOW, HIGH] });
      const columns = Object.fromEntries(
        Object.entries(quantiles).map(([column, found]) => [column, { low: found[LOW], high: found[HIGH] }]),
      );
      const band = { count: runs, of: options.runs, time, columns, milliseconds: performance.now() - start };
      post({ kind: "band", id, text, band, last: runs === options.runs });
    }
  },

  /** Put another choice (a type, a law) in, and take out the keys that belong to the old one. */
  choose({ id, text, name, path, value, needed }) {
    let edited = changed(text, setting(text, path, value));
    const section = path.slice(0, path.lastIndexOf("."));
    for (let round = 0; round < MOST_ROUNDS; round += 1) {
      const { problems } = core.read(edited, { name });
      const alien = problems.find((problem) => problem.rule.includes("other_choice"));
      const missing = problems.find((problem) => `${section}.${lastOf(problem.key)}` === problem.key && lastOf(problem.key) in needed);
      if (alien) edited = changed(edited, removing(edited, alien.key));
      else if (missing) edited = changed(edited, setting(edited, missing.key, needed[lastOf(missing.key)]));
      else break;
    }
    post({ kind: "chosen", id, text: edited, before: text });
  },

  pose({ id, text, name, point, near }) {
    post({ kind: "pose", id, pose: poseTowards(core, text, { name, point, near }) });
  },

  csv({ id, text, name }) {
    post({ kind: "csv", id, csv: core.run(text, { name }).csv() });
  },
};

function lastOf(path) {
  return path.slice(path.lastIndexOf(".") + 1);
}

function post(message, moved = []) {
  self.postMessage(message, moved);
}

self.onmessage = async ({ data }) => {
  try {
    await answers[data.kind](data);
  } catch (error) {
    post({ kind: "failed", id: data.id, message: error.message, problems: error.problems ?? [], dead: core?.dead ?? true });
  }
};
