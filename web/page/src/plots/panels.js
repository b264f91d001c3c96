/** The panels beside the scene: which columns stand together, in which unit, with which look. */
import { DEGREE } from "../app/numbers.js";

const STILL = 1e-6; // m: a coordinate of the tip that changes less has no panel of its own
const [DASHED, DOTTED, DASH_DOTTED] = [[7, 4], [2, 3], [8, 3, 2, 3]];
const LOOKS = [["blue", []], ["red", DASHED], ["green", DASH_DOTTED]];
const FORCE = ["onWall", []];
const MEASURED = ["measured", []];
const REFERENCE = ["ink", DASHED];
const JOINTS = ["₁", "₂", "₃"];

/** Series of three columns that belong together. */
function three(names, labels) {
  return names.map((column, i) => one(column, labels[i], LOOKS[i]));
}

function joints(name, symbol) {
  return three([1, 2, 3].map((joint) => `${name}${joint}`), JOINTS.map((sub) => symbol + sub));
}

function one(column, label, look = LOOKS[0]) {
  return { column, label, look };
}

const ALL = [
  { name: "force", title: "Pressing force", unit: "N",
    series: [one("force", "force", FORCE), one("force_measured", "measured", MEASURED), one("force_ref", "reference", REFERENCE)] },
  { name: "force_on_wall", title: "Force on the wall", unit: "N",
    series: three(["f_on_wall_x", "f_on_wall_y", "f_on_wall_z"], ["x", "y", "z"]) },
  { name: "angles", title: "Joint angles", unit: "rad", angle: true, series: joints("q", "q") },
  ...["x", "y", "z"].map((axis) => ({ name: `tip_${axis}`, title: `Tip, ${axis}`, unit: "mm", scale: 1e3, flat: 2,
    series: [one(`tip_${axis}`, "tip"), one(`tip_ref_${axis}`, "reference", REFERENCE)] })),
  { name: "depth", title: "Depth of the tip in the wall", unit: "mm", scale: 1e3, zero: true, series: [one("depth", "depth")] },
  { name: "torques", title: "Torques", unit: "N m", series: joints("tau", "τ") },
  { name: "residuals", title: "Residual of the observer", unit: "N m", series: joints("residual", "r") },
  { name: "stiffness", title: "Estimated stiffness", unit: "N/m", series: [one("stiffness_estimate", "estimate")] },
  { name: "tank", title: "Energy in the tank", unit: "J", series: [one("tank_energy", "tank")] },
  { name: "rates", title: "Joint rates", unit: "rad/s", angle: true, series: joints("qd", "q̇") },
  { name: "energies", title: "Energies", unit: "J", series: [
    one("work_actuators", "work of actuators", ["amber", [], 3.2]), one("work_wall", "external work", ["pink", [], 2.4]),
    one("energy_kinetic", "kinetic"), { ...one("energy_potential", "Δ potential", LOOKS[1]), change: true },
    one("energy_contact", "contact", LOOKS[2]), one("energy_dissipated", "dissipated", ["ink", DOTTED])] },
]; // prettier-ignore

/** The series of a panel that a run has columns for. */
export function seriesOf(name, columns) {
  return ALL.find((panel) => panel.name === name).series.filter((one) => shows(one, columns));
}

/** The panels of a run, each with the series that it has; `first`: whether it is drawn when none has been chosen. degrees:
 * whether angles are in degrees. */
export function panelsOf({ columns, resolved }, degrees) {
  const found = ALL.map((panel) => ({ ...inUnit(panel, degrees), series: seriesOf(panel.name, columns) }));
  const drawn = found.filter((panel) => panel.series.length > 0);
  const has = (name) => drawn.some((panel) => panel.name === name);
  return drawn.map((panel) => ({ ...panel, first: isFirst(panel.name, columns, resolved, has) }));
}

function inUnit(panel, degrees) {
  return panel.angle && degrees ? { ...panel, unit: panel.unit.replace("rad", "°"), scale: 1 / DEGREE } : panel;
}

function shows({ column }, columns) {
  if (!(column in columns)) return false;
  if (column === "force_measured") return columns.force.some((force, i) => Math.abs(force - columns.force_measured[i]) > 1e-9);
  if (column.startsWith("energy_") || column.startsWith("work_")) {
    return column === "energy_kinetic" || column === "energy_potential" || columns[column].some((value) => value !== 0);
  }
  return true;
}

function isFirst(name, columns, resolved, has) {
  if (name === "force") return "force_ref" in columns || has("residuals");
  if (name === "force_on_wall") return "depth" in columns && !("force_ref" in columns);
  if (name === "depth") return "depth" in columns && !("tip_ref_x" in columns);
  if (name.startsWith("tip_")) return moves(columns[name]) || (name === "tip_x" && !["tip_x", "tip_y", "tip_z"].some((tip) => moves(columns[tip])));
  if (name === "energies") return !("depth" in columns);
  return !["rates"].includes(name) && resolved !== null;
}

function moves(column) {
  let [low, high] = [Infinity, -Infinity];
  for (const value of column) {
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return high - low > STILL;
}
