/** A button over the scene that is dragged by a pointer or moved by keys. What it moves is the matter of its subclass. */
const STEPS = { ArrowRight: [1, 0, 0], ArrowLeft: [-1, 0, 0], ArrowUp: [0, 1, 0], ArrowDown: [0, -1, 0], PageUp: [0, 0, -1], PageDown: [0, 0, 1] };
const FAST = 10; // steps at once, with Shift
const SIDE = 26; // px

export class Handle {
  /** element: the button. scene: that it lies over. A subclass has pointOf(pose), begin(place), drag(place), nudge(step), end(). */
  constructor(element, scene) {
    Object.assign(this, { element, scene, held: false });
    element.addEventListener("pointerdown", (event) => this.#press(event));
    element.addEventListener("pointermove", (event) => this.held && this.drag(this.#placeOf(event)));
    element.addEventListener("lostpointercapture", () => this.#release());
    element.addEventListener("keydown", (event) => this.#key(event));
    element.addEventListener("keyup", () => this.held || this.end());
  }

  /** Stand where the pose is. Returns the box that the button covers, px; null where it is not seen. */
  place(pose) {
    const point = this.pointOf(pose);
    const { view } = this.scene;
    const [x, y] = point ? view.pixels(point) : [-SIDE, -SIDE];
    this.element.hidden = !this.held && (x < 0 || y < 0 || x > view.width || y > view.height);
    if (this.element.hidden) return null;
    this.element.style.transform = `translate(${x - SIDE / 2}px, ${y - SIDE / 2}px)`;
    return [x - SIDE / 2, y - SIDE / 2, x + SIDE / 2, y + SIDE / 2];
  }

  #press(event) {
    if (event.button !== 0) return;
    event.preventDefault(); // no text is selected
    this.element.focus();
    this.element.setPointerCapture(event.pointerId);
    this.held = true;
    this.begin(this.#placeOf(event));
  }

  #release() {
    this.held = false;
    this.end();
    this.scene.frame();
  }

  #key(event) {
    const step = STEPS[event.key];
    if (!step) return;
    event.preventDefault();
    event.stopPropagation(); // the arrows move the present time elsewhere
    this.nudge(step.map((part) => part * (event.shiftKey ? FAST : 1)));
  }

  /** [x, y] in the scene, px. */
  #placeOf({ clientX, clientY }) {
    const { left, top } = this.scene.canvas.getBoundingClientRect();
    return [clientX - left, clientY - top];
  }
}
