/** Guided stops: the lecture's questions, each with a scenario, a change to try, and what is then seen. */
import { at } from "../app/dom.js";
import { changed, setting } from "../scenario/edit.js";
import stops from "./stops.json";

export class Tour {
  /** examples: as for the menu. open(text, name) shows a scenario. */
  constructor(store, { editor, transport, predict, examples, open }) {
    Object.assign(this, { store, editor, transport, predict, open });
    this.texts = new Map(examples.map((one) => [one.name, one.text]));
    this.stop = -1;
    at("tour-next").addEventListener("click", () => this.go(1));
    at("tour-back").addEventListener("click", () => this.go(-1));
    at("tour-try").addEventListener("click", () => this.#try());
    at("tour-predict").addEventListener("click", () => this.#predict());
    at("tour-close").addEventListener("click", () => this.close());
    at("tour-start").addEventListener("click", () => this.go(1));
  }

  /** Go to the next stop (1) or the one before (-1). */
  go(step) {
    const next = this.stop + step;
    if (next < 0 || next >= stops.length) return this.close();
    this.stop = next;
    this.#arrive(stops[next]);
    return undefined;
  }

  close() {
    this.stop = -1;
    document.body.classList.remove("touring");
    this.#setBand(0);
    at("tour-start").focus();
  }

  #arrive(stop) {
    document.body.classList.add("touring");
    at("tour-count").textContent = `${this.stop + 1} of ${stops.length}`;
    at("tour-title").textContent = stop.title;
    at("tour-question").textContent = stop.question;
    at("tour-try").textContent = stop.action;
    at("tour-answer").textContent = stop.answer;
    at("tour-answer").hidden = true;
    at("tour-predict").hidden = !stop.predict;
    at("tour-back").disabled = this.stop === 0;
    at("tour-next").textContent = this.stop === stops.length - 1 ? "End" : "Next";
    this.store.set({ range: null, playing: false });
    this.open(edited(this.texts.get(stop.scenario), { ...stop.set, checks: JSON.stringify(stop.before) }), stop.scenario);
    this.#setBand(stop.band ?? 0);
    at("tour").focus();
  }

  #try() {
    this.predict.end();
    this.#change();
    this.transport.replay(stops[this.stop].speed);
    this.#answer();
  }

  /** The same change, but what it does is drawn before it is seen. */
  #predict() {
    this.#change();
    this.predict.start({ ...stops[this.stop].predict, done: () => this.#answer() });
  }

  #change() {
    const { then, after } = stops[this.stop];
    const checks = after.length > 0 ? { checks: JSON.stringify(after) } : {};
    this.editor.replace(edited(this.store.get("text"), { ...then, ...checks }));
  }

  #answer() {
    at("tour-answer").hidden = false;
    at("tour-answer").scrollIntoView({ block: "nearest" });
  }

  /** percent: 0 takes the band away. */
  #setBand(percent) {
    at("band-on").checked = percent > 0;
    if (percent > 0) at("band-within").value = String(percent);
    at("band-within").dispatchEvent(new Event("input"));
  }
}

/** A scenario's text with values (YAML) at paths. */
function edited(text, values) {
  return Object.entries(values).reduce((now, [path, value]) => changed(now, setting(now, path, value)), text);
}
