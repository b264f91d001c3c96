/** Short texts beside what the scene shows: elements over the picture, sharp at any size, that cover none of it. */
import { make } from "../app/dom.js";
import { freePlace } from "./placement.js";

const LETTER = 7.2; // px, about as wide as a letter
const EDGE = 7; // px beside the letters
const HEIGHT = 17; // px, of a label
const SIDE = [1, 0]; // of its point, where a label stands if nothing says otherwise

export class Labels {
  /** layer: the element that the labels lie in. over: the other elements over the scene. */
  constructor(layer, over) {
    Object.assign(this, { layer, over, labels: new Map() });
  }

  resize(width, height) {
    Object.assign(this, { width, height });
    this.measure();
  }

  /** Where the other elements over the scene stand: asked when they change, for it costs a layout. */
  measure() {
    const { left, top } = this.layer.getBoundingClientRect();
    const boxes = this.over.map((one) => one.getBoundingClientRect()).filter((box) => box.width > 0);
    this.covered = boxes.map((box) => [box.left - left, box.top - top, box.right - left, box.bottom - top]);
  }

  /**
   * Show these labels and no others, each where it covers nothing; one that finds no such place is not shown.
   *
   * wanted: { name, text, point: beside which it stands, from: a point on whose far side it stands best, colour, mark: colour
   * of its edge }. pieces: made by piece(). boxes: px. view: of the scene.
   */
  show(wanted, { pieces, boxes, view }) {
    const [right] = view.axes;
    const lines = pieces.map(({ from, to, radius }) => {
      const [a, b, beside] = [from, to, from.clone().addScaledVector(right, radius)].map((point) => view.pixels(point));
      return [...a, ...b, Math.hypot(beside[0] - a[0], beside[1] - a[1])];
    });
    const taken = [...this.covered, ...boxes];
    const names = new Set(wanted.map(({ name }) => name));
    for (const [name, label] of this.labels) if (!names.has(name)) label.element.hidden = true;
    for (const one of wanted) {
      const box = this.#put(one, { area: [0, 0, this.width, this.height], boxes: taken, lines }, view);
      if (box) taken.push(box);
    }
  }

  /** Returns the box that the label takes, null where it is not shown. */
  #put({ name, text, point, from, colour = "", mark = "transparent" }, room, view) {
    const label = this.labels.get(name) ?? this.#made(name);
    const at = view.pixels(point);
    const back = from ? view.pixels(from) : null;
    const away = back ? [at[0] - back[0], at[1] - back[1]] : SIDE;
    const found = freePlace({ point: at, size: [LETTER * text.length + EDGE, HEIGHT], away, place: label.place }, room);
    label.element.hidden = !found;
    label.place = found?.place ?? -1;
    if (!found) return null;
    if (label.element.textContent !== text) label.element.textContent = text;
    label.element.style.color = colour;
    label.element.style.borderColor = mark;
    label.element.style.transform = `translate(${found.box[0]}px, ${found.box[1]}px)`;
    return found.box;
  }

  #made(name) {
    const element = make("span", { className: "scene-label" });
    this.layer.append(element);
    this.labels.set(name, { element, place: -1 });
    return this.labels.get(name);
  }
}
