/** The pose that brings the tip to a point, or towards it as far as the arm reaches. */

const PLACES = 33; // on the way to a point out of reach; twice, the second time between two neighbours
const TURN = 2 * Math.PI;

/**
 * { q, tip }: joint angles, rad, as near to those given as there are, and the tip that they have; null where there are none.
 *
 * A point out of reach is approached straight from the shoulder, from the distance that the tip has now.
 */
export function poseTowards(core, text, { name, point, near }) {
  const solve = (way) => nearest(core.inverseKinematics(text, way.flat(), { name }), near);
  const direct = solve([point]);
  if (direct.length > 0) return { q: direct, tip: point };
  const { points, tip } = core.positions(text, near, { name });
  const shoulder = [...points.slice(3, 6)];
  const share = distance(tip, shoulder) / distance(point, shoulder);
  let [from, to] = [between(shoulder, point, share), point];
  let q = null;
  for (let round = 0; round < 2; round += 1) {
    const way = Array.from({ length: PLACES }, (_, i) => between(from, to, i / (PLACES - 1)));
    const found = solve(way);
    const reached = found.length / 3;
    if (reached === 0) return null;
    q = found.slice(-3);
    [from, to] = [way[reached - 1], way[Math.min(reached, PLACES - 1)]];
  }
  return { q, tip: from };
}

/** Of the branches' angles, 3 a point, those that begin nearest to a pose, in turns about it. */
function nearest(branches, pose) {
  const turned = branches.map((q) => [...q].map((angle, i) => angle - TURN * Math.round((angle - pose[i % 3]) / TURN)));
  const far = (q) => (q.length === 0 ? Infinity : distance(q.slice(0, 3), pose));
  return turned.reduce((best, q) => (far(q) < far(best) ? q : best));
}

function between(a, b, share) {
  return a.map((part, i) => part + share * (b[i] - part));
}

function distance(a, b) {
  return Math.hypot(...[0, 1, 2].map((i) => a[i] - b[i]));
}
