/** What the page says: in a line for all, and to screen readers. */
import { at } from "../app/dom.js";
import { later } from "../app/frames.js";

export function startStatus(store) {
  const line = at("status");
  let timer = 0;
  const say = (text) => {
    line.textContent = text;
    line.classList.add("said");
    clearTimeout(timer);
    timer = setTimeout(() => line.classList.remove("said"), 5000);
  };
  const tell = () => {
    const { length } = store.get("problems");
    const run = store.get("run");
    document.body.classList.toggle("stale", length > 0 || Boolean(store.get("failure")));
    if (length > 0) line.textContent = `${length} ${length === 1 ? "problem" : "problems"} in the text: the last run is shown`;
    else if (store.get("failure")) line.textContent = store.get("failure");
    else if (run) line.textContent = summary(run);
  };
  store.on(["busy"], () => document.body.classList.toggle("busy", store.get("busy")));
  store.on(["run", "problems", "failure"], () => later("status", tell));
  return say;
}

function summary({ name, summary: { outcome }, checks }) {
  const failed = checks.filter((check) => !check.passed).length;
  const judged = checks.length === 0 ? "" : failed === 0 ? ", all checks passed" : `, ${failed} of ${checks.length} checks failed`;
  return `${name}: ${outcome}${judged}`;
}
