/** A straight piece of what the scene shows, which labels must not cover: from one point to another, with a radius, m. */
import { Vector3 } from "three";

export function piece(from, to, radius) {
  return { from: new Vector3(...from), to: new Vector3(...to), radius };
}
