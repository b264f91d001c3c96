/** Keys that work wherever no text is written and no control has a use for them. */
import { at } from "../app/dom.js";

const TYPING = "input:not([type=range]):not([type=checkbox]), select, textarea, .cm-content, dialog";

export function startKeyboard(store, { transport, scene, plots, editor, menu, tour }) {
  const view = (name) => () => scene?.view.look(name);
  const turn = (name) => () => store.set({ [name]: !store.get(name) });
  const keys = {
    " ": () => transport.toggle(),
    ArrowRight: (event) => transport.step(event.shiftKey ? 10 : 1),
    ArrowLeft: (event) => transport.step(event.shiftKey ? -10 : -1),
    Home: () => transport.step(-100),
    End: () => transport.step(100),
    "<": () => transport.change(-1),
    ">": () => transport.change(1),
    "+": () => plots.magnify(0.5),
    "-": () => plots.magnify(2),
    0: () => store.set({ range: null }),
    1: view("whole"),
    2: view("side"),
    3: view("front"),
    4: view("top"),
    a: turn("axes"),
    g: turn("ghost"),
    b: turn("energies"),
    u: turn("degrees"),
    e: () => showEditor(),
    m: () => menu.show(),
    o: () => at("open-file").click(),
    d: () => at("predict-start").click(),
    n: () => tour.go(1),
    p: () => tour.go(-1),
    "?": () => at("help").showModal(),
  };
  const showEditor = () => {
    store.set({ tab: "text" });
    editor.focus();
  };
  const changeBack = (event) => {
    const key = event.key.toLowerCase();
    if (key !== "z" && key !== "y") return;
    event.preventDefault();
    if (key === "y" || event.shiftKey) editor.redo();
    else editor.undo();
  };
  document.addEventListener("keydown", (event) => {
    const { target } = event;
    if (event.altKey || target.closest(TYPING)) return;
    if (event.ctrlKey || event.metaKey) return changeBack(event);
    const taken = target.matches("input[type=range]") && /^(Arrow|Home|End)/.test(event.key);
    const pressed = target.matches("button, summary, input[type=checkbox]") && event.key === " ";
    if (taken || pressed || !(event.key in keys)) return;
    event.preventDefault();
    keys[event.key](event);
  });
}
