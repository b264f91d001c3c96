/** Where the page starts: makes its parts, and shows the scenario or the run that it was given. */
import "uplot/dist/uPlot.min.css";
import "../style/theme.css";
import "../style/layout.css";
import "../style/parts.css";
import "../style/editor.css";
import "../style/watch.css";
import "../style/predict.css";
import "../style/files.css";
import { at } from "./app/dom.js";
import { given } from "./app/given.js";
import { Store } from "./app/store.js";
import { startTheme } from "./app/theme.js";
import { Controls } from "./controls/controls.js";
import { TipHandle } from "./drag/tip_handle.js";
import { WallHandle } from "./drag/wall_handle.js";
import { Editor } from "./editor/editor.js";
import { startFiles } from "./files/files.js";
import { startBand } from "./parts/band.js";
import { Checks } from "./parts/checks.js";
import { startDownloads } from "./parts/downloads.js";
import { EnergyBars } from "./parts/energy_bars.js";
import { startKeyboard } from "./parts/keyboard.js";
import { Menu } from "./parts/menu.js";
import { startShown } from "./parts/shown.js";
import { startStatus } from "./parts/status.js";
import { startTabs } from "./parts/tabs.js";
import { Tour } from "./parts/tour.js";
import { Transport } from "./parts/transport.js";
import { Plots } from "./plots/plots.js";
import { Predict } from "./predict/predict.js";
import { textOf } from "./scenario/link.js";
import { Scene } from "./scene/scene.js";
import { recordedRun } from "./simulate/recorded.js";
import { keepRunBefore } from "./simulate/run_before.js";
import { Simulation, shippedScenarios } from "./simulate/simulation.js";
import { startCaption } from "./watch/caption.js";

const FIRST = "moving_wall";

const store = new Store({
  before: null, ghost: true, energies: true, degrees: true,
  text: "", name: "scenario", checked: "", problems: [], warnings: [], failure: "", resolved: null, schema: null, opened: 0,
  run: null, panels: [], band: { within: 0, keys: [] }, bandRun: null, busy: false, tab: "", theme: "light",
  time: 0, playing: false, speed: 1, range: null, axes: true, chosenPlots: {}, guess: null, measured: null,
}); // prettier-ignore

async function start() {
  startTheme(store);
  startTabs(store);
  const say = startStatus(store);
  const examples = await shippedScenarios();
  const simulation = new Simulation(store);
  const editor = new Editor(store);
  const open = (text, name) => {
    store.set({ name: name.split("/").at(-1) });
    at("scenario-name").textContent = name.replaceAll("_", " ");
    editor.open(text);
    store.set({ opened: store.get("opened") + 1 });
  };
  const parts = makeParts({ editor, simulation, examples, open });
  startBand(store);
  startShown(store);
  keepRunBefore(store);
  startDownloads(store, simulation, parts, say);
  startFiles(store, parts.show, say);
  startKeyboard(store, { ...parts, editor });
  await openFirst(open, examples);
  await simulation.start();
  document.body.classList.add("started");
}

function makeParts({ editor, simulation, examples, open }) {
  const transport = new Transport(store);
  const plots = new Plots(store);
  startCaption(store);
  new Checks(store);
  new Controls(store, editor, simulation);
  new EnergyBars(store);
  const scene = sceneOrNull();
  const show = (text, name) => {
    store.set({ range: null, playing: false });
    open(text, name);
  };
  const menu = new Menu(examples, (example) => show(example.text, example.name));
  const predict = new Predict(store, transport);
  const tour = new Tour(store, { editor, transport, predict, examples, open });
  for (const button of document.querySelectorAll("[data-view]")) {
    button.addEventListener("click", () => scene?.view.look(button.dataset.view));
  }
  if (scene) scene.handles = [new TipHandle(store, scene, { editor, simulation, transport }), new WallHandle(store, scene, editor)];
  at("open-help").addEventListener("click", () => at("help").showModal());
  at("help-close").addEventListener("click", () => at("help").close());
  return { transport, plots, scene, menu, tour, show };
}

/** A browser without WebGL shows all but the scene. */
function sceneOrNull() {
  try {
    return new Scene(store);
  } catch (error) {
    at("scene").classList.add("missing");
    at("scene-missing").textContent = `This browser cannot draw in three dimensions (${error.message}); all else works.`;
    return null;
  }
}

/** The run or the scenario that Python gave, or that of the link, or the lecture's. */
async function openFirst(open, examples) {
  const data = given("arm3r-data");
  const run = data?.matrix ? await recordedRun(data) : null;
  const linked = data ? null : await textOf(location.hash);
  const example = examples.find((one) => one.name === FIRST);
  if (data) open(data.scenario, data.name);
  else if (linked !== null) open(linked, "scenario");
  else open(example.text, example.name);
  if (run) store.set({ run: { ...run, text: data.scenario }, resolved: run.resolved });
}

start().catch((error) => {
  document.body.classList.add("broken");
  at("status").textContent = `The page cannot start: ${error.message}`;
});
