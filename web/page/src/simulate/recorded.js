/** A run that Python put into the page: its rows to the last bit, not simulated again. */
import { unpacked } from "../app/given.js";
import { watchOf } from "../watch/moments.js";

/** As the worker sends a run. data: { scenario, resolved, columns, units, matrix, arm, summary, report }. */
export async function recordedRun(data) {
  const numbers = new Float64Array(await unpacked(data.matrix));
  const rows = numbers.length / data.columns.length;
  const columns = {};
  data.columns.forEach((name, i) => {
    columns[name] = numbers.subarray(i * rows, (i + 1) * rows);
  });
  const [points, axes] = await Promise.all([data.arm.points, data.arm.axes].map(unpacked));
  const arm = { points: new Float64Array(points), axes: new Float64Array(axes), reach: data.arm.reach };
  const { summary, report, resolved } = data;
  const { events, checks, name } = summary;
  const run = { columns, units: data.units, events, summary, checks, report, resolved, arm, name, recorded: true };
  return { ...run, watch: watchOf(run) };
}

/** The run as CSV; each number reads back to the same bits. */
export function csvOf(run) {
  const names = Object.keys(run.columns);
  const lines = [names.join(",")];
  const count = run.columns.t.length;
  for (let i = 0; i < count; i += 1) lines.push(names.map((name) => run.columns[name][i]).join(","));
  return `${lines.join("\n")}\n`;
}
