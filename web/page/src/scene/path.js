/** A line through points of a run, as wide on any screen. */
import { Line2 } from "three/addons/lines/Line2.js";
import { LineGeometry } from "three/addons/lines/LineGeometry.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { thin } from "../simulate/thin.js";

const MOST = 1500; // points

export class Path {
  constructor(look) {
    this.material = new LineMaterial({ worldUnits: false, ...look });
    this.line = new Line2(new LineGeometry(), this.material);
    this.line.frustumCulled = false;
  }

  /** axes: columns x, y, z. Returns the rows that are drawn. */
  set(axes, rows = thin(axes, 0, axes[0].length, MOST)) {
    const places = new Float32Array(3 * Math.max(2, rows.length));
    for (let i = 0; i < places.length; i += 1) places[i] = axes[i % 3][rows[Math.min((i / 3) | 0, rows.length - 1)]];
    this.line.geometry.dispose();
    this.line.geometry = new LineGeometry().setPositions(places);
    if (this.material.dashed) this.line.computeLineDistances();
    return rows;
  }
}
