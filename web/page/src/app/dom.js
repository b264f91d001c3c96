/** Elements of the page. Text always becomes a text node: nothing that a scenario says is read as HTML. */

/** Make an element; `props` are its properties, those that contain "-" and `role` attributes. */
export function make(tag, props = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(props)) {
    if (name.includes("-") || name === "role") element.setAttribute(name, value);
    else element[name] = value;
  }
  element.append(...children);
  return element;
}

/** The element of the page that has this id. */
export function at(id) {
  return document.getElementById(id);
}

/** Let a browser save a file. */
export function save(name, blob) {
  const link = make("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
