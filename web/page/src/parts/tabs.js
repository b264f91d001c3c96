/** Panels that share a place: beside a wide scene plots, text, checks or report; on a phone the values, too. */
import { at } from "../app/dom.js";

export function startTabs(store) {
  const tabs = [...at("tabs").querySelectorAll("[role=tab]")];
  const show = () => {
    const name = store.get("tab");
    document.body.dataset.tab = name;
    for (const tab of tabs) {
      tab.setAttribute("aria-selected", String(tab.dataset.tab === name));
      tab.tabIndex = tab.dataset.tab === name ? 0 : -1;
    }
  };
  for (const tab of tabs) tab.addEventListener("click", () => store.set({ tab: tab.dataset.tab }));
  at("tabs").addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    event.stopPropagation();
    const seen = tabs.filter((tab) => tab.offsetParent);
    const next = seen[(seen.indexOf(document.activeElement) + step + seen.length) % seen.length];
    next.focus();
    next.click();
  });
  const narrow = matchMedia("(max-width: 759px)");
  const fit = () => {
    if (!narrow.matches && store.get("tab") === "sliders") store.set({ tab: "plots" });
  };
  narrow.addEventListener("change", fit);
  store.on(["tab"], show);
  store.on(["problems"], () => !store.get("run") && store.get("problems").length > 0 && store.set({ tab: "text" }));
  store.set({ tab: "plots" });
}
