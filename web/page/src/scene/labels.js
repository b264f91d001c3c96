/** Short texts that stand beside things in the scene: elements over the picture, so that they are sharp at any size. */
import { make } from "../app/dom.js";

const LETTER = 7.2; // px, about as wide as a letter

export class Labels {
  constructor(layer) {
    this.layer = layer;
    this.elements = new Map();
  }

  resize(width, height) {
    Object.assign(this, { width, height });
  }

  /** Put a text at a point (Vector3), or take it away where it is "". from: the text lies on the far side of this point. */
  put(name, text, point, camera, { colour = "", from = null } = {}) {
    const element = this.elements.get(name) ?? this.#made(name);
    const place = point.clone().project(camera);
    element.hidden = !text || place.z > 1;
    if (element.hidden) return;
    if (element.textContent !== text) element.textContent = text;
    element.style.color = colour;
    const left = Boolean(from) && place.x < from.clone().project(camera).x;
    const width = LETTER * text.length;
    const beside = ((place.x + 1) / 2) * this.width + (left ? -6 : 6);
    const x = left ? Math.max(beside, width) : Math.min(beside, this.width - width);
    element.style.transform = `translate(${x}px, ${((1 - place.y) / 2) * this.height}px)${left ? " translateX(-100%)" : ""}`;
  }

  #made(name) {
    const element = make("span", { className: "scene-label" });
    this.layer.append(element);
    this.elements.set(name, element);
    return element;
  }
}
