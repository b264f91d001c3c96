/** The sentence that says what to watch, above the time. */
import { at } from "../app/dom.js";
import { later } from "../app/frames.js";

const BEFORE_UNIT = /(?<=\d) (?=[µm]?[mNsJ]\b)/g; // no line ends there

export function startCaption(store) {
  const say = () => {
    const guess = store.get("guess");
    const sentence = guess && !guess.seen ? "Draw what you expect, then see it." : store.get("run").watch.sentence;
    at("watch").textContent = sentence.replace(BEFORE_UNIT, "\u00a0");
  };
  store.on(["run", "guess"], () => later("watch", say));
}
