/** Light or dark: what the system asks for, until the button says otherwise. */
import { at } from "./dom.js";

const DARK = matchMedia("(prefers-color-scheme: dark)");

export function startTheme(store) {
  const apply = (theme) => {
    document.documentElement.dataset.theme = theme;
    store.set({ theme });
  };
  apply(DARK.matches ? "dark" : "light");
  DARK.addEventListener("change", () => apply(DARK.matches ? "dark" : "light"));
  at("theme").addEventListener("click", () => apply(store.get("theme") === "dark" ? "light" : "dark"));
}
