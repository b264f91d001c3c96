/** What the picture of a run is to hold, and where its floor lies. */
import { plateSize, poseAt } from "./pose.js";

const NEAR = 1.3; // reaches of the arm from the base, within which the wall is to be seen
const TIMES = 20; // of the run, from start to end

/** What is to be seen: the base with its axes; at some times of the run the arm, and the wall where it is near. */
export function pointsOf(run, size, floor) {
  const { t } = run.columns;
  const sides = run.resolved.wall ? plateSize(run.resolved.wall) : null;
  const points = [[0, 0, floor], [-0.12 * size, -0.42 * size, floor], [0.1 * size, -0.42 * size, floor]];
  for (let k = 0; k <= TIMES; k += 1) {
    const pose = poseAt(run, t[0] + (k / TIMES) * (t[t.length - 1] - t[0]));
    points.push(...pose.points.slice(1));
    if (pose.wall && sides) points.push(...corners(pose.wall, sides).filter((corner) => Math.hypot(...corner) < NEAR * size));
  }
  return points;
}

function corners({ point, e1, e2 }, [along1, along2]) {
  return [-1, 1].flatMap((a) => [-1, 1].map((b) => point.map((part, k) => part + (a * along1 * e1[k] + b * along2 * e2[k]) / 2)));
}

/** Height of the floor: that of the base, or below all that the tip does, in steps of half the reach. */
export function floorOf({ columns, arm }, size) {
  const height = arm.points[5];
  let lowest = Math.min(0, height);
  for (const z of columns.tip_z) lowest = Math.min(lowest, z);
  if (height > 0.1 * size && lowest >= 0) return 0;
  return -Math.max(1, Math.ceil((-lowest / size) * 2 - 1e-6)) * 0.5 * size;
}
