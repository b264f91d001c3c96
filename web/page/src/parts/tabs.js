/** Panels that share a place. Beside a wide scene stand the text or the checks; on a phone, one panel of all. */
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
    if (!narrow.matches && ["plots", "sliders"].includes(store.get("tab"))) store.set({ tab: "text" });
  };
  narrow.addEventListener("change", fit);
  store.on(["tab"], show);
  store.set({ tab: narrow.matches ? "plots" : "text" });
  show();
}
