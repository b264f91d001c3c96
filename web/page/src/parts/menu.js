/** All scenarios of arm3r with their pictures, to choose from. */
import { at, make } from "../app/dom.js";

export class Menu {
  /** examples: [{ name, folder, summary, text, picture }]; open(example) is called with the one that is chosen. */
  constructor(examples, open) {
    this.dialog = at("menu");
    this.open = open;
    at("open-menu").addEventListener("click", () => this.show());
    at("menu-close").addEventListener("click", () => this.dialog.close());
    at("menu-search").addEventListener("input", (event) => this.#filter(event.target.value));
    const folders = [...new Set(examples.map((one) => one.folder))];
    this.cards = [];
    at("menu-list").replaceChildren(...folders.map((folder) => this.#section(folder, examples)));
  }

  show() {
    this.dialog.showModal();
    at("menu-search").focus();
  }

  #section(folder, examples) {
    const cards = examples.filter((one) => one.folder === folder).map((one) => this.#card(one));
    const title = folder === "" ? "To begin with" : folder.replaceAll("_", " ");
    return make("section", {}, make("h3", {}, title), make("div", { className: "cards" }, ...cards));
  }

  #card(example) {
    const picture = example.picture
      ? make("img", { src: example.picture, alt: "", loading: "lazy" })
      : make("span", { className: "no-picture" });
    const card = make("button", { type: "button", className: "card" }, picture,
      make("span", {}, make("b", {}, example.name.split("/").at(-1).replaceAll("_", " ")), make("small", {}, example.summary))); // prettier-ignore
    card.dataset.name = example.name;
    card.addEventListener("click", () => {
      this.dialog.close();
      this.open(example);
    });
    this.cards.push([card, `${example.name} ${example.summary}`.replaceAll("_", " ").toLowerCase()]);
    return card;
  }

  #filter(words) {
    const wanted = words.toLowerCase().split(/\s+/);
    for (const [card, text] of this.cards) card.hidden = !wanted.every((word) => text.includes(word));
    for (const section of at("menu-list").children) section.hidden = !section.querySelector(".card:not([hidden])");
  }
}
