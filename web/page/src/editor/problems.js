/** The problems of a scenario, each under its line. */
import { StateEffect, StateField } from "@codemirror/state";
import { Decoration, EditorView, WidgetType } from "@codemirror/view";
import { make } from "../app/dom.js";

const LONG = 60; // letters of what is allowed

/** Takes a list of problems as the simulator tells them: line, column, key, message, value, allowed, hint. */
export const setProblems = StateEffect.define();

class Message extends WidgetType {
  constructor(problem) {
    super();
    this.problem = problem;
  }

  eq(other) {
    return sentence(other.problem) === sentence(this.problem);
  }

  toDOM() {
    return make("div", { className: "problem", role: "note" }, sentence(this.problem));
  }
}

/** What is wrong, what is allowed, and the likely fix; a long list of what is allowed gives way to the fix. */
function sentence({ key, message, value, allowed, hint }) {
  const parts = [`${key ? `${key}: ` : ""}${message}`, value && `got ${value}`];
  if (allowed && !(hint && allowed.length > LONG)) parts.push(`allowed ${allowed}`);
  return parts.filter(Boolean).join(", ") + (hint ? `; ${hint}` : "");
}

const wrong = Decoration.mark({ class: "wrong" });

function decorations(doc, problems) {
  const found = problems.flatMap((problem) => {
    const line = doc.line(Math.min(Math.max(1, problem.line || 1), doc.lines));
    const from = Math.min(line.from + Math.max(0, (problem.column || 1) - 1), line.to);
    const rest = /^[^\s,:}\]#]+/.exec(doc.sliceString(from, line.to));
    const under = Decoration.widget({ widget: new Message(problem), block: true, side: 1 }).range(line.to);
    return rest ? [wrong.range(from, from + rest[0].length), under] : [under];
  });
  return Decoration.set(found, true);
}

export const problemField = StateField.define({
  create: () => Decoration.none,
  update(shown, transaction) {
    for (const effect of transaction.effects) {
      if (effect.is(setProblems)) return decorations(transaction.state.doc, effect.value);
    }
    return shown.map(transaction.changes);
  },
  provide: (field) => EditorView.decorations.from(field),
});
