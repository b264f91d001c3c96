/** The floor, and on it the directions x, y, z of the base frame. */
import { GridHelper, Group, Vector3 } from "three";
import { Arrow } from "./arrow.js";

export class Ground {
  constructor() {
    this.axes = [0, 1, 2].map(() => new Arrow("#888888", 1));
    this.object = new Group().add(...this.axes.map((axis) => axis.object));
    this.grid = null;
  }

  colour(theme) {
    this.theme = theme;
    for (const axis of this.axes) axis.material.color.set(theme.faint);
    if (this.grid) this.grid.material.color.set(theme.floor);
  }

  place(size, floor) {
    if (!this.grid || this.size !== size) this.#makeGrid(size);
    this.grid.position.z = floor;
    this.axes.forEach((axis, i) => {
      axis.thickness = 0.004 * size;
      axis.point(new Vector3(-0.12 * size, -0.42 * size, floor), new Vector3(+(i === 0), +(i === 1), +(i === 2)).multiplyScalar(0.22 * size));
    });
  }

  /** What labels must not cover. */
  get pieces() {
    return this.axes.flatMap((axis) => axis.pieces);
  }

  /** A floor of squares of half a link's length. */
  #makeGrid(size) {
    this.grid?.geometry.dispose();
    this.grid?.removeFromParent();
    this.grid = new GridHelper(3 * size, 12, "#ffffff", "#ffffff");
    this.grid.rotation.x = Math.PI / 2;
    this.grid.material.vertexColors = false;
    this.grid.material.transparent = true;
    this.grid.material.opacity = 0.8;
    this.grid.material.color.set(this.theme.floor);
    this.size = size;
    this.object.add(this.grid);
  }
}
