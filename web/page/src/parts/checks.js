/** How the run ended: its checks, its contacts, its numbers, and what it warns of. */
import { at, make } from "../app/dom.js";
import { later } from "../app/frames.js";
import { shown } from "../app/numbers.js";

const EVENT_WORDS = { make: "contact begins", break: "contact ends" };
const MOST_EVENTS = 20;

export class Checks {
  constructor(store) {
    this.store = store;
    store.on(["run", "warnings", "bandRun"], () => later("checks", () => this.#show()));
  }

  #show() {
    const run = this.store.get("run");
    if (!run) return;
    const passed = run.checks.filter((check) => check.passed).length;
    const count = at("check-count");
    count.textContent = run.checks.length > 0 ? `${passed}/${run.checks.length}` : "";
    count.classList.toggle("failed", passed < run.checks.length);
    at("checks").replaceChildren(this.#heading(run), ...this.#band(), ...this.#warnings(run), checkList(run), eventList(run));
    at("report").textContent = run.report ?? "";
  }

  #heading({ summary, name, milliseconds, recorded }) {
    const good = summary.outcome === "ok";
    const time = recorded ? "recorded run, not simulated again" : `simulated in ${shown(milliseconds, 3)} ms`;
    return make("p", { className: "outcome" }, make("b", {}, name), " ",
      make("span", { className: good ? "passed" : "failed" }, summary.outcome), ` · ${time}`,
      summary.message ? make("span", { className: "failed" }, ` · ${summary.message}`) : "",
      make("code", { title: "hash over all columns: the same on Linux, Windows and in the browser" }, ` ${summary.hash ?? ""}`)); // prettier-ignore
  }

  #band() {
    const band = this.store.get("bandRun");
    if (!band) return [];
    const more = band.count < band.of ? `, ${band.of} to come` : "";
    return [make("p", {}, `Band: 90 % of ${band.count} runs, in ${shown(band.milliseconds, 3)} ms${more}.`)];
  }

  #warnings({ summary }) {
    const all = [...new Set([...(summary.warnings ?? []), ...(this.store.get("warnings") ?? [])])];
    return all.map((sentence) => make("p", { className: "warning" }, sentence));
  }
}

function checkList({ checks }) {
  if (checks.length === 0) return make("p", { className: "faint" }, "This scenario has no checks.");
  return make("ul", { className: "checks" }, ...checks.map((check) => {
    const { name, passed, value, limit } = check;
    return make("li", { className: passed ? "passed" : "failed" },
      make("span", { className: "mark", "aria-label": passed ? "passed" : "failed" }, passed ? "✓" : "✗"),
      make("span", { className: "check-name" }, name),
      make("span", { className: "check-value" }, `${shown(value, 6)}`, make("small", {}, ` ${limit ?? ""}`)));
  })); // prettier-ignore
}

function eventList({ events, summary }) {
  const lines = events.slice(0, MOST_EVENTS).map((event) => `${EVENT_WORDS[event.type] ?? event.type} at ${shown(event.t, 7)} s`);
  if (events.length > MOST_EVENTS) lines.push(`and ${events.length - MOST_EVENTS} more`);
  if (summary.peak_force > 0) lines.push(`largest force ${shown(summary.peak_force, 6)} N`);
  if (summary.energy_residual_max !== undefined) lines.push(`energy balance closes to ${shown(Number(summary.energy_residual_max), 2)} J`);
  return make("ul", { className: "events" }, ...lines.map((line) => make("li", {}, line)));
}
