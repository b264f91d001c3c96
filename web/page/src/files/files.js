/** Files that are dropped on the page, or chosen: a scenario opens, a measurement stands beside the run, a robot is told of. */
import { at, make } from "../app/dom.js";
import { readLog } from "../measured/log.js";

const IMPORT = "arm3r import"; // the command that makes a scenario of a robot

/** open(text, name): shows a scenario. say(text): tells what was done. */
export function startFiles(store, open, say) {
  const kinds = {
    yaml: (text, name) => open(text, stemOf(name)),
    csv: async (text, name) => {
      const log = await readLog(text, name, store.get("run").units);
      store.set({ measured: log });
      const others = log.others.length > 0 ? `; not drawn, as no column of the run is called so: ${log.others.join(", ")}` : "";
      say(`${name} is drawn beside the run: ${Object.keys(log.columns).join(", ")}${others}`);
    },
    urdf: (text, name) => tellOfRobot(text, name),
  };
  const take = async (file) => {
    if (!file) return;
    const kind = kindOf(file.name);
    try {
      if (!kind) throw new Error(`${file.name}: a scenario (.yaml), a measurement (.csv) or a robot (.urdf) is needed`);
      await kinds[kind](await file.text(), file.name);
    } catch (error) {
      tell("This file cannot be used", error.message);
    }
  };
  const input = at("file");
  at("open-file").addEventListener("click", () => input.click());
  input.addEventListener("change", () => {
    at("menu").close();
    take(input.files[0]);
    input.value = "";
  });
  startDrop(take);
  at("note-close").addEventListener("click", () => at("note").close());
  at("measured-end").addEventListener("click", () => store.set({ measured: null }));
  store.on(["measured"], () => {
    at("measured").hidden = !store.get("measured");
    at("measured-name").textContent = store.get("measured")?.name ?? "";
  });
}

/** The whole page takes files, and is marked while one is over it. */
function startDrop(take) {
  const isFile = (event) => event.dataTransfer?.types.includes("Files");
  const mark = (on) => document.body.classList.toggle("dropping", on);
  document.addEventListener("dragover", (event) => {
    if (!isFile(event)) return;
    event.preventDefault();
    mark(true);
  });
  document.addEventListener("dragleave", (event) => mark(Boolean(event.relatedTarget)));
  document.addEventListener("drop", (event) => {
    if (!isFile(event)) return;
    event.preventDefault();
    event.stopPropagation(); // the editor would take its text
    mark(false);
    take(event.dataTransfer.files[0]);
  }, true); // prettier-ignore
}

function kindOf(name) {
  const end = name.split(".").at(-1).toLowerCase();
  return { yaml: "yaml", yml: "yaml", csv: "csv", txt: "csv", tsv: "csv", urdf: "urdf", xml: "urdf", xacro: "urdf" }[end];
}

function stemOf(name) {
  return name.replace(/\.\w+$/, "");
}

function tellOfRobot(text, name) {
  if (!/<robot[\s>]/.test(text)) throw new Error(`${name}: a URDF has an element <robot>, and this file has none`);
  const stem = stemOf(name.replace(/\.xacro$/, ""));
  const commands = [...(/xacro/.test(name) ? [`xacro ${name} > ${stem}.urdf`] : []), `${IMPORT} ${stem}.urdf > ${stem}.yaml`];
  const why = `Python reads robots, this page scenarios. ${commands.length > 1 ? "These commands make" : "This command makes"} ` +
    `${stem}.yaml with the arm of ${name}, or say what would make it an arm of three joints:`; // prettier-ignore
  tell("From a robot to a scenario", why, commands.join("\n"), `Then drop ${stem}.yaml here.`);
}

function tell(title, text, commands = "", then = "") {
  at("note-title").textContent = title;
  at("note-text").replaceChildren(make("p", {}, text), ...(commands ? [make("pre", {}, commands), make("p", {}, then)] : []));
  at("note").showModal();
}
