/** The state of the page: values by name, and the functions that are called when one of them changes. */
export class Store {
  #values;
  #listeners = [];

  constructor(values) {
    this.#values = { ...values };
  }

  get(name) {
    return this.#values[name];
  }

  /** Set values; each listener is called once, if a value that it names has changed. */
  set(changes) {
    const changed = Object.keys(changes).filter((name) => changes[name] !== this.#values[name]);
    Object.assign(this.#values, changes);
    for (const [names, listener] of this.#listeners) {
      if (names.some((name) => changed.includes(name))) listener(this);
    }
  }

  /** Call a listener after each change of one of the values with these names. */
  on(names, listener) {
    this.#listeners.push([names, listener]);
  }
}
