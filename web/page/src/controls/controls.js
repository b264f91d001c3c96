/** The scenario as controls: a slider for each number, a list for each choice, a switch for each yes or no. */
import { at, make } from "../app/dom.js";
import { later } from "../app/frames.js";
import { yaml } from "../app/numbers.js";
import { setting } from "../scenario/edit.js";
import { find } from "../scenario/tree.js";
import { linkMass, number, valueAt } from "../scenario/values.js";
import { Choice, Switch } from "./choice.js";
import { keyOf } from "./schema.js";
import { GROUPS, NEEDED, SECTIONS, shownPaths } from "./shown_keys.js";
import { Slider } from "./slider.js";

export class Controls {
  #controls = new Map();
  #known = "";

  constructor(store, editor, simulation) {
    Object.assign(this, { store, editor, simulation });
    this.list = at("controls");
    store.on(["resolved", "schema"], () => later("controls", () => this.#show()));
  }

  #show() {
    const { resolved, schema } = { resolved: this.store.get("resolved"), schema: this.store.get("schema") };
    if (!resolved || !schema) return;
    const paths = GROUPS.map((group) => group.sections.flatMap((section) => shownPaths(resolved, section)));
    const known = JSON.stringify(paths);
    const opened = this.store.get("opened") !== this.opened;
    if (known !== this.#known) this.#build(paths, resolved, schema);
    this.#known = known;
    this.opened = this.store.get("opened");
    for (const [path, control] of this.#controls) control.show(valueOf(resolved, path), opened);
  }

  /** Make the groups anew; one that was folded stays folded. */
  #build(paths, resolved, schema) {
    const folded = new Map([...this.list.querySelectorAll("details")].map((one) => [one.dataset.title, !one.open]));
    const old = this.#controls;
    this.#controls = new Map();
    const focused = document.activeElement?.dataset?.path;
    const groups = GROUPS.map((group, i) => {
      const controls = paths[i].map((path) => old.get(path) ?? this.#made(path, resolved, schema)).filter(Boolean);
      for (const control of controls) this.#controls.set(control.path, control);
      const missing = group.sections.filter((section) => section in SECTIONS && !resolved[section] && fits(section, resolved));
      const buttons = missing.map((section) => this.#adder(section));
      if (controls.length + buttons.length === 0) return "";
      const open = folded.has(group.title) ? !folded.get(group.title) : group.open && controls.length > 0;
      const details = make("details", { open }, make("summary", {}, group.title), ...controls.map((one) => one.element), ...buttons);
      details.dataset.title = group.title;
      return details;
    });
    this.list.replaceChildren(...groups.filter(Boolean));
    if (focused) this.#controls.get(focused)?.input.focus();
  }

  #made(path, resolved, schema) {
    const key = keyOf(schema, resolved, path);
    if (key.isSwitch) return new Switch(path, key, (value) => this.#set(path, value));
    if (key.choices) return new Choice(path, key, (value) => this.#choose(path, value));
    if (typeof valueOf(resolved, path) !== "number") return null;
    return new Slider(path, key, (value, joined) => this.#set(path, value, joined));
  }

  #adder(section) {
    const button = make("button", { type: "button", className: "small" }, `Add ${section === "sensors" ? "noise" : section}`);
    button.addEventListener("click", () => this.#set(section, SECTIONS[section]));
    return button;
  }

  #set(path, value, joined = false) {
    this.editor.changeSoon(path, (text, tree) => this.#change(text, tree, path, value), joined);
  }

  /** What puts a value into the text: an item of a list that the text lacks comes with the whole list. Null where the
   *  controls are still those of the scenario before. */
  #change(text, tree, path, value) {
    if (this.opened !== this.store.get("opened")) return null;
    const list = /^(.*)\[(\d+)\]$/.exec(path);
    if (!list || find(text, tree, list[1])?.name.endsWith("Sequence")) return setting(text, path, value, tree);
    const items = valueAt(this.store.get("resolved"), list[1]).map((item) => yaml(number(item)));
    items[Number(list[2])] = value;
    return setting(text, list[1], `[${items.join(", ")}]`, tree);
  }

  /** Another type or law: the simulator says which keys go with it. The last choice counts. */
  async #choose(path, value) {
    const text = this.store.get("text");
    const needed = NEEDED[path] ?? {};
    const answer = this.simulation.choose(path, value, needed).catch(() => null);
    this.chosen = answer;
    const chosen = await answer;
    if (chosen !== null && this.chosen === answer && this.store.get("text") === text) this.editor.replace(chosen);
  }
}

function valueOf(resolved, path) {
  const link = /^arm\.(link[23])\.mass$/.exec(path);
  return link ? linkMass(resolved.arm[link[1]]) : valueAt(resolved, path);
}

/** Whether a section may stand beside the controller. */
function fits(section, { controller }) {
  return !["sampling", "sensors"].includes(section) || !["none", "constant"].includes(controller?.type ?? "none");
}
