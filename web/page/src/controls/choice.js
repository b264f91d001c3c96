/** A word of the scenario as a list to choose from, and a yes or no as a switch. */
import { make } from "../app/dom.js";

export class Choice {
  /** change(word) is called when the user chooses. */
  constructor(path, key, change) {
    this.path = path;
    const name = path.split(".").slice(1).join(" ").replaceAll("_", " ");
    const options = key.choices.map((word) => make("option", { value: word }, word.replaceAll("_", " ")));
    this.input = make("select", { "aria-label": path }, ...options);
    this.input.dataset.path = path;
    this.element = make("label", { className: "choice", title: `${path}: ${key.description}` }, make("span", {}, name), this.input);
    this.input.addEventListener("change", () => change(this.input.value));
  }

  show(value) {
    this.input.value = value;
  }
}

export class Switch {
  constructor(path, key, change) {
    this.path = path;
    const name = path.split(".").slice(1).join(" ").replaceAll("_", " ");
    this.input = make("input", { type: "checkbox", "aria-label": path });
    this.input.dataset.path = path;
    this.element = make("label", { className: "switch", title: `${path}: ${key.description}` }, this.input, ` ${name}`);
    this.input.addEventListener("change", () => change(String(this.input.checked)));
  }

  show(value) {
    this.input.checked = value === true;
  }
}
