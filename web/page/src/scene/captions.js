/** What is written in the scene, for Labels: the joints with their angles, the directions of the base, both forces. */
import { Vector3 } from "three";
import { JOINTS, ON_TIP, ON_WALL } from "../app/colours.js";
import { angleText } from "../app/numbers.js";

/** parts: of the scene. degrees: whether angles are in degrees. */
export function captions(parts, pose, { theme, degrees }) {
  return [...ofForces(parts.forces, pose), ...ofJoints(parts, pose, degrees), ...ofDirections(parts.ground, theme)];
}

function ofForces({ onWall, onTip }, { tip }) {
  const forces = [["on the wall", onWall, ON_WALL], ["on the tip", onTip, ON_TIP]].filter(([, arrow]) => arrow.text);
  const from = new Vector3(...tip);
  return forces.map(([name, arrow, mark]) => ({ name, text: `${name} ${arrow.text}`, point: arrow.tip, from, mark }));
}

function ofJoints({ axes }, { q }, degrees) {
  if (!axes.object.visible) return [];
  return axes.arrows.map(({ from, tip }, i) => {
    return { name: `q${i + 1}`, text: `q${"₁₂₃"[i]} ${angleText(q[i], degrees)}`, point: tip, from, colour: JOINTS[i] };
  });
}

function ofDirections({ axes }, { faint }) {
  return axes.map(({ from, tip }, i) => ({ name: "xyz"[i], text: "xyz"[i], point: tip, from, colour: faint }));
}
