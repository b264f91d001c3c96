/** The panels beside the scene: which columns stand together, in which unit, with which look. */

const STILL = 1e-6; // m: a coordinate of the tip that changes less has no panel of its own
const LOOKS = [["blue", []], ["red", [7, 4]], ["green", [2, 3]], ["amber", [8, 3, 2, 3]], ["sky", []], ["pink", [7, 4]], ["ink", [2, 3]]];
const FORCE = ["onWall", []];
const MEASURED = ["measured", []];
const REFERENCE = ["ink", [7, 4]];
const JOINTS = ["₁", "₂", "₃"];

/** Series of three columns that belong together. */
function three(names, labels, first = 0) {
  return names.map((column, i) => ({ column, label: labels[i], look: LOOKS[first + i] }));
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
  { name: "angles", title: "Joint angles", unit: "rad", series: joints("q", "q") },
  ...["x", "y", "z"].map((axis) => ({ name: `tip_${axis}`, title: `Tip, ${axis}`, unit: "mm", scale: 1e3, flat: 2,
    series: [one(`tip_${axis}`, "tip"), one(`tip_ref_${axis}`, "reference", REFERENCE)] })),
  { name: "depth", title: "Depth of the tip in the wall", unit: "mm", scale: 1e3, zero: true, series: [one("depth", "depth")] },
  { name: "torques", title: "Torques", unit: "N m", series: joints("tau", "τ") },
  { name: "residuals", title: "Residual of the observer", unit: "N m", series: joints("residual", "r") },
  { name: "stiffness", title: "Estimated stiffness", unit: "N/m", series: [one("stiffness_estimate", "estimate")] },
  { name: "tank", title: "Energy in the tank", unit: "J", series: [one("tank_energy", "tank")] },
  { name: "rates", title: "Joint rates", unit: "rad/s", series: joints("qd", "q̇") },
  { name: "energies", title: "Energies", unit: "J", series: [
    one("energy_kinetic", "kinetic"), { ...one("energy_potential", "Δ potential", LOOKS[1]), change: true },
    one("energy_contact", "contact", LOOKS[2]), one("work_actuators", "work of actuators", LOOKS[3]), one("work_wall", "work of wall", LOOKS[5]),
    one("energy_dissipated", "dissipated", LOOKS[6])] },
]; // prettier-ignore

/** The panels of a run, each with the series that it has; `first`: whether it is drawn when none has been chosen. */
export function panelsOf({ columns, resolved }) {
  const found = ALL.map((panel) => ({ ...panel, series: panel.series.filter((one) => shows(one, columns)) }));
  const drawn = found.filter((panel) => panel.series.length > 0);
  const has = (name) => drawn.some((panel) => panel.name === name);
  return drawn.map((panel) => ({ ...panel, first: isFirst(panel.name, columns, resolved, has) }));
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
