/** The scenario as text. The store has the same text at all times; sliders change it through the editor, so that undo works. */
import { defaultKeymap, history, historyKeymap, indentWithTab, redo, undo } from "@codemirror/commands";
import { yaml } from "@codemirror/lang-yaml";
import { HighlightStyle, bracketMatching, ensureSyntaxTree, indentUnit, syntaxHighlighting } from "@codemirror/language";
import { searchKeymap } from "@codemirror/search";
import { EditorState } from "@codemirror/state";
import { EditorView, drawSelection, highlightActiveLine, keymap, lineNumbers } from "@codemirror/view";
import { tags } from "@lezer/highlight";
import { at } from "../app/dom.js";
import { later } from "../app/frames.js";
import { problemField, setProblems } from "./problems.js";

const LOOK = HighlightStyle.define([
  { tag: tags.comment, color: "var(--faint)", fontStyle: "italic" },
  { tag: [tags.propertyName, tags.definition(tags.propertyName)], color: "var(--key)" },
  { tag: [tags.string, tags.number, tags.bool, tags.content], color: "var(--ink)" },
  { tag: tags.punctuation, color: "var(--faint)" },
]);

export class Editor {
  constructor(store) {
    this.store = store;
    this.view = new EditorView({ parent: at("editor"), state: this.#state("") });
    store.on(["problems", "failure"], () => later("problems", () => this.#showProblems()));
  }

  /** Take another scenario: with a history of its own. */
  open(text) {
    this.view.setState(this.#state(text));
    this.store.set({ text });
  }

  /**
   * Change the text in the next frames, one step of the work in each.
   *
   * change(text, tree) gives { from, to, insert }, or null for none; it is asked again where the text has become another
   * one meanwhile.
   * `joined`: it continues the change before, for undo. A change that waits under the same name is replaced.
   */
  changeSoon(name, change, joined) {
    const { state } = this.view;
    const soon = (step) => later(`text-${name}`, () => (this.view.state === state ? step() : this.changeSoon(name, change, joined)));
    const tree = ensureSyntaxTree(state, state.doc.length, Infinity);
    const changes = change(state.doc.toString(), tree);
    if (!changes) return;
    soon(() => {
      // Only to the last kind does the history join a change that comes late.
      const transaction = state.update({ changes, userEvent: joined ? "input.type.compose" : "input" });
      soon(() => this.view.dispatch(transaction));
    });
  }

  /** Put a whole text in place of the present one. */
  replace(insert) {
    this.view.dispatch({ changes: { from: 0, to: this.view.state.doc.length, insert }, userEvent: "input" });
  }

  undo() {
    undo(this.view);
  }

  redo() {
    redo(this.view);
  }

  focus() {
    this.view.focus();
  }

  #state(doc) {
    return EditorState.create({
      doc,
      extensions: [
        lineNumbers(), EditorView.lineWrapping, history(), drawSelection(), bracketMatching(), highlightActiveLine(), indentUnit.of("  "),
        yaml(), syntaxHighlighting(LOOK), problemField,
        keymap.of([{ key: "Escape", run: () => this.#leave() }, ...defaultKeymap, ...historyKeymap, ...searchKeymap, indentWithTab]),
        EditorView.contentAttributes.of({ "aria-label": "Scenario, as YAML; Escape leaves the editor" }),
        EditorView.updateListener.of((update) => {
          if (update.docChanged) this.store.set({ text: update.state.doc.toString() });
        }),
      ],
    }); // prettier-ignore
  }

  /** Tab indents here: Escape gives the keyboard back to the page. */
  #leave() {
    this.view.contentDOM.blur();
    return true;
  }

  #showProblems() {
    if (this.store.get("checked") !== this.store.get("text")) return; // newer ones are under way
    const { problems, failure } = { problems: this.store.get("problems"), failure: this.store.get("failure") };
    const all = problems.length > 0 || !failure ? problems : [{ line: 1, column: 1, message: failure }];
    if (all.length === 0 && this.view.state.field(problemField).size === 0) return;
    this.view.dispatch({ effects: setProblems.of(all) });
  }
}
