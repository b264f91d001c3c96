/** Values of a resolved scenario, which has every default. */
import { parts } from "./tree.js";

/** The value at a path such as wall.contact.stiffness or initial.q[0]; undefined where there is none. */
export function valueAt(resolved, path) {
  return parts(path).reduce((value, part) => value?.[part] ?? undefined, resolved);
}

/** JSON has no infinity: the word stands for it. */
export function number(value) {
  return value === "inf" ? Infinity : value === "-inf" ? -Infinity : value;
}

/** The mass of a link, kg, also where its shape gives it. */
export function linkMass(link) {
  if (typeof link.mass === "number") return link.mass;
  const { length, section, radius, density } = link;
  return density * length * (link.shape === "cylinder" ? Math.PI * radius ** 2 : section[0] * section[1]);
}
