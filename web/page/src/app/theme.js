/** Light or dark: what the system asks for, until the button says otherwise. */
import { ON_TIP, ON_WALL } from "./colours.js";
import { at } from "./dom.js";

const DARK = matchMedia("(prefers-color-scheme: dark)");

export function startTheme(store) {
  const { style } = document.documentElement;
  style.setProperty("--on-wall", ON_WALL);
  style.setProperty("--on-tip", ON_TIP);
  const apply = (theme) => {
    document.documentElement.dataset.theme = theme;
    store.set({ theme });
  };
  apply(DARK.matches ? "dark" : "light");
  DARK.addEventListener("change", () => apply(DARK.matches ? "dark" : "light"));
  at("theme").addEventListener("click", () => apply(store.get("theme") === "dark" ? "light" : "dark"));
}
