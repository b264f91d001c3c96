/** What can be taken away: a link, the scenario, the rows, a picture. */
import { at, save } from "../app/dom.js";
import { linkOf } from "../scenario/link.js";
import { csvOf } from "../simulate/recorded.js";
import { picture } from "./picture.js";

export function startDownloads(store, simulation, { scene, plots }, say) {
  const stem = () => (store.get("run")?.name ?? "scenario").replace(/[^\w.-]+/g, "_");
  const click = (id, work) =>
    at(id).addEventListener("click", async () => {
      at("take").open = false;
      try {
        say(await work());
      } catch (error) {
        say(`It did not work: ${error.message}`);
      }
    });

  click("take-link", async () => {
    const link = await linkOf(store.get("text"));
    history.replaceState(null, "", link);
    await navigator.clipboard.writeText(link);
    return "The link is in the clipboard. It carries the whole scenario.";
  });
  click("take-yaml", () => {
    save(`${stem()}.yaml`, new Blob([store.get("text")], { type: "application/yaml" }));
    return "The scenario is saved.";
  });
  click("take-csv", async () => {
    const run = store.get("run");
    const csv = run.recorded && run.text === store.get("text") ? csvOf(run) : await simulation.csv();
    save(`${stem()}.csv`, new Blob([csv], { type: "text/csv" }));
    return "All rows and columns are saved.";
  });
  click("take-picture", async () => {
    save(`${stem()}.png`, await picture(store, scene, plots));
    return "The picture is saved.";
  });
}
