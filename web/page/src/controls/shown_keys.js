/** Which keys of a scenario have a slider, a list or a switch, and under which heading. The text has all of them. */

export const GROUPS = [
  { title: "Pose", sections: ["initial"], open: true },
  { title: "Wall", sections: ["wall"], open: true },
  { title: "Controller", sections: ["controller"], open: true },
  { title: "Reference", sections: ["reference"], open: false },
  { title: "Sampling and sensors", sections: ["sampling", "sensors"], open: true },
  { title: "Observer and estimator", sections: ["observer", "estimator"], open: false },
  { title: "Push", sections: ["push"], open: false },
  { title: "Arm", sections: ["arm"], open: true },
  { title: "Time and method", sections: ["solver", "time"], open: false },
];

/** Keys for the text alone: shapes, directions, tolerances, tables, and choices between many that need others. */
const TEXT_ONLY = [
  /^arm\.(link1|rotor\d|joint_sign|joint_zero|model)\b/, /\.(section|density|com|inertia|radius|shape)\b/, /^arm\.gravity\[[01]\]/, /friction_velocity$/,
  /slip_velocity$/, /normal\b/, /^wall\.size/, /direction\b/, /axis\b/, /^wall\.motion\.[tsva]\b/, /^reference\.[txyz]\b/,
  /^solver\.(rtol|atol|tol|max_step|max_steps)$/, /^time\.(log_every|start)$/, /^controller\.model/, /preset$/, /torque_limit/,
  /^estimator\.largest_condition$/, /^arm\.armature/, /^reference\.type$/, /^wall\.rotation\.type$/,
  /^reference\.force\.type$/, /^sensors\.[a-z]+\.(counts|estimate)$/, /^wall\.contact\.(restitution|impact_speed)$/,
]; // prettier-ignore

/** Sections that a scenario may lack, and the text that puts them in. */
export const SECTIONS = {
  wall: "{}", sampling: "{rate: 1000}", sensors: "{force: {noise: 0.2}}", observer: "{}", estimator: "{}",
  push: "{force: [5, 0, 0], start: 1}",
}; // prettier-ignore

/** What a choice needs beside it, where it has no default. */
export const NEEDED = {
  "wall.motion.type": { amplitude: "0.05", frequency: "0.5", distance: "0.3", duration: "5", t: "[0, 5]", s: "[0, 0.3]", v: "[0, 0]", a: "[0, 0]" },
  "wall.contact.law": { stiffness: "[1000, 1000, 1000]", damping: "10", dissipation: "0.5" },
  "controller.type": { torque: "[0, 0, 0]" },
  "controller.adaptation": { assumed_stiffness: "1000" },
};

/** The paths of the values of a section that have a control: numbers, words and switches, in the scenario's order. */
export function shownPaths(resolved, section) {
  const found = leaves(resolved[section], section);
  const masses = section === "arm" ? ["arm.link2.mass", "arm.link3.mass"] : []; // absent where the shape gives them
  return [...new Set([...masses, ...found])].filter((path) => !TEXT_ONLY.some((rule) => rule.test(path)));
}

function leaves(value, path) {
  if (value === null || value === undefined || value === "inf") return [];
  if (Array.isArray(value)) return value.flatMap((item, i) => leaves(item, `${path}[${i}]`));
  if (typeof value === "object") return Object.entries(value).flatMap(([name, item]) => leaves(item, `${path}.${name}`));
  return [path];
}
