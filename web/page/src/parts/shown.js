/** What the scene shows beside the arm: switches of the values with these names in the store. */
export function startShown(store) {
  for (const box of document.querySelectorAll("[data-shown]")) {
    const name = box.dataset.shown;
    box.addEventListener("change", () => store.set({ [name]: box.checked }));
    store.on([name], () => (box.checked = store.get(name)));
  }
}
