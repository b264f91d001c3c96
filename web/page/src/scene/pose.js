/** Where everything stands at one time of a run: points in m, base axes. */
import { number } from "../scenario/values.js";
import { valueOf, valuesOf } from "../simulate/thin.js";

const XYZ = ["x", "y", "z"];

/**
 * Joint angles, points of the arm, axes of its joints, face of the wall, both forces at a time, s; straight between rows.
 *
 * points: of axis 1 nearest to the origin, of axis 1 at the height of joint 2, joint 2, the end of link 2 in its plane,
 * joint 3, the end of link 3 in its plane, the tip. up: along axis 1, away from the base.
 */
export function poseAt(run, time) {
  const { columns, resolved, arm } = run;
  const value = (name) => valueOf(columns.t, columns[name], time);
  const three = (name) => XYZ.map((axis) => value(`${name}_${axis}`));
  const points = vectors(valuesOf(columns.t, arm.points, time));
  const axes = vectors(valuesOf(columns.t, arm.axes, time)).map(unit);
  const { wall } = resolved;
  return {
    q: [1, 2, 3].map((joint) => value(`q${joint}`)),
    points,
    axes,
    up: axes[0].map((part) => part * (resolved.arm.joint_sign?.[0] ?? 1)),
    tip: points.at(-1),
    wall: wall && "wall_x" in columns ? faceOf(wall, three("wall"), time) : null,
    forceOnTip: three("f_on_tip"),
    forceOnWall: three("f_on_wall"),
    contact: value("contact") > 0.5,
  };
}

/** Three numbers each. */
function vectors(numbers) {
  return Array.from({ length: numbers.length / 3 }, (_, i) => [...numbers.slice(3 * i, 3 * i + 3)]);
}

/** The face of the plate, whose frame has this origin at a time. */
function faceOf(wall, origin, time) {
  const frame = wallFrame(wall, time);
  return { point: origin.map((part, i) => part + wall.face_offset * frame.normal[i]), ...frame };
}

/** Unit vectors of the plate at a time, model (4.1): normal towards the arm, e1 and e2 along the plate. */
export function wallFrame(wall, time) {
  const normal = unit(wall.normal);
  const level = Math.hypot(normal[0], normal[1]);
  const e1 = level >= 1e-12 ? [normal[1] / level, -normal[0] / level, 0] : [0, 1, 0];
  const angle = turned(wall.rotation, time);
  const [n, a] = angle === 0 ? [normal, e1] : [normal, e1].map((axis) => rotated(axis, unit(wall.rotation.axis), angle));
  return { normal: n, e1: a, e2: cross(a, n) };
}

/** By how much the wall has turned since t = 0, rad. */
function turned(rotation, time) {
  if (!rotation || rotation.type === "none") return 0;
  if (rotation.type === "constant") return rotation.rate * time;
  const { amplitude, frequency, phase } = rotation;
  return amplitude * (Math.sin(2 * Math.PI * frequency * time + phase) - Math.sin(phase));
}

/** Rodrigues' formula. */
function rotated(v, axis, angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const along = dot(axis, v);
  return cross(axis, v).map((part, i) => v[i] * c + part * s + axis[i] * along * (1 - c));
}

/** Sides of the plate, m; null: it is infinite. */
export function plateSize(wall) {
  return Array.isArray(wall.size) ? wall.size.map(number) : null;
}

export function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

export function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

export function unit(v) {
  const size = Math.hypot(...v);
  return v.map((part) => part / size);
}
