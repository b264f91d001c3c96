/** What is to be watched in a run: one sentence whose numbers are those of the run, and when it happens. */
import { shown } from "../app/numbers.js";
import { contactSpans } from "../plots/contact.js";

const STILL = 1e-9; // m: a tip that moves less stays where it is
const AT_ONCE = 1e-6; // s after the start: contact that begins before is there from the start
const FALL = 1e-3; // m: less is no fall
const FALLEN = 0.99; // of how deep a tip falls
const BOUNCES = 3; // so many times of contact are bounces
const CLOSE = 0.005; // a share of a force in which two forces are equal
const DIGITS = 3;

/**
 * { sentence, column, begins, lasts, moment } of a run as the worker sends it.
 *
 * column: what the sentence speaks of. begins, lasts: when what is to be watched happens, s. moment: the time to show
 * where nothing may move, s.
 */
export function watchOf(run) {
  const spans = contactSpans(run);
  const { t } = run.columns;
  const [start, end] = [t[0], t[t.length - 1]];
  const told = ownQuantity(run) ?? (spans.length > 0 ? ofContact(run, spans) : ofMotion(run));
  const begins = spans[0]?.[0] ?? start;
  const leaves = run.events.at(-1)?.type === "break";
  const lasts = (spans.length > 0 && leaves ? spans.at(-1)[1] : end) - begins;
  return { begins, lasts, moment: end, ...told };
}

/** Of a run whose scenario computes a quantity that others lack: a residual without contact, a stiffness, a tank. */
function ownQuantity({ columns, events }) {
  const { t, stiffness_estimate: stiffness, tank_energy: tank } = columns;
  if (stiffness) {
    const found = stiffness.at(-1) > 0 ? `in the end it finds ${said(stiffness.at(-1))} N/m` : `in ${duration(t.at(-1) - t[0])} it finds none`;
    return { column: "stiffness_estimate", sentence: `Watch the estimator of the wall's stiffness: ${found}.` };
  }
  if (tank && tank.at(-1) !== tank[0]) {
    return { column: "tank_energy", sentence: `Watch the energy in the tank: ${said(tank[0])} J at first, ${said(tank.at(-1))} J in the end.` };
  }
  if ("residual1" in columns && events.length === 0) {
    const largest = [1, 2, 3].map((joint) => `residual${joint}`).reduce((a, b) => (peak(columns[a]) >= peak(columns[b]) ? a : b));
    const value = columns[largest][peakRow(columns[largest])];
    return { column: largest, sentence: `Watch the observer's residual of joint ${largest.at(-1)}: it reaches ${said(value)} N m.` };
  }
  return null;
}

function ofContact(run, spans) {
  const { columns, events, summary, resolved } = run;
  const { t, force } = columns;
  const [[begins]] = spans;
  const met = begins - t[0] > AT_ONCE;
  const [most, final] = [peak(force), force.at(-1)];
  const strongest = t[peakRow(force)];
  const about = { column: "force", moment: strongest };
  const [, ends] = spans.at(-1);
  if (spans.length >= BOUNCES) {
    const since = met ? `first at ${said(begins)} s` : "from the start";
    return { ...about, sentence: `Watch the tip bounce on the wall: it touches it ${spans.length} times, ${since}, with up to ${said(summary.peak_force)} N.` };
  }
  if (events.at(-1)?.type === "break") {
    const since = met ? `the contact at ${said(begins)} s` : "the contact";
    return { ...about, sentence: `Watch ${since}: it ends after ${duration(ends - begins)}, with up to ${said(summary.peak_force)} N.` };
  }
  const since = met ? ` after the contact at ${said(begins)} s` : "";
  const stays = !resolved.wall.acts_on_arm && farthest(columns).distance < STILL ? ", and the arm, which does not feel it, stays where it is" : "";
  const steady = Math.abs(most - final) <= CLOSE * most;
  return { ...about, moment: steady ? t.at(-1) : strongest, sentence: `Watch the pressing force${since}: it ${course(force, most, steady)}${wanted(columns)}${stays}.` };
}

/** most: the largest force, N. steady: whether it is the last. */
function course(force, most, steady) {
  const final = force.at(-1);
  if (!steady && peakRow(force) === 0) return `goes from ${said(most)} N at first to ${said(final)} N in the end`;
  if (!steady) return `peaks at ${said(most)} N and ends at ${said(final)} N`;
  const even = force.every((value) => Math.abs(value - final) <= CLOSE * final);
  return even ? `stays at ${said(final)} N` : `grows to ${said(final)} N`;
}

function wanted({ force_ref: reference }) {
  return reference ? `, where ${said(reference.at(-1))} N are wanted` : "";
}

function ofMotion({ columns }) {
  const { t } = columns;
  const { distance, row, axis } = farthest(columns);
  const length = duration(t.at(-1) - t[0]);
  if (distance < STILL) {
    return { column: "tip_z", sentence: `Watch that nothing moves: for ${length} the tip stays within 0.001 mm.` };
  }
  const about = { column: `tip_${axis}`, moment: t[row] };
  const drop = columns.tip_z.map((z) => columns.tip_z[0] - z);
  const deepest = drop.reduce((a, b) => Math.max(a, b), 0);
  if (deepest > Math.max(FALL, distance / 2)) {
    const low = drop.findIndex((depth) => depth >= FALLEN * deepest);
    return { column: "tip_z", moment: t[low], sentence: `Watch the tip fall: ${far(drop[low])} in the first ${duration(t[low] - t[0])}.` };
  }
  if (row === t.length - 1) return { ...about, sentence: `Watch the tip: after ${length} it is ${far(distance)} away from its start.` };
  return { ...about, sentence: `Watch the tip: it moves up to ${far(distance)} away from its start, at ${said(t[row])} s.` };
}

/** { distance, row, axis }: how far the tip comes from where it was first, m, in which row, most of it along which axis. */
function farthest(columns) {
  const axes = ["x", "y", "z"];
  const tip = axes.map((axis) => columns[`tip_${axis}`]);
  let [distance, row] = [0, 0];
  for (let i = 1; i < tip[0].length; i += 1) {
    const here = Math.hypot(...tip.map((column) => column[i] - column[0]));
    if (here > distance) [distance, row] = [here, i];
  }
  const parts = tip.map((column) => Math.abs(column[row] - column[0]));
  return { distance, row, axis: axes[parts.indexOf(Math.max(...parts))] };
}

function peakRow(column) {
  let row = 0;
  for (let i = 1; i < column.length; i += 1) if (Math.abs(column[i]) > Math.abs(column[row])) row = i;
  return row;
}

function peak(column) {
  return Math.abs(column[peakRow(column)]);
}

function said(value) {
  return shown(value, DIGITS);
}

function duration(seconds) {
  return seconds < 0.1 ? `${said(1e3 * seconds)} ms` : `${said(seconds)} s`;
}

function far(metres) {
  if (metres < 1e-5) return `${said(1e6 * metres)} µm`;
  return metres < 0.1 ? `${said(1e3 * metres)} mm` : `${said(metres)} m`;
}
