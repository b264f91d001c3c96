/** A band of many runs: which numbers are uncertain, and by how much. */
import { at, make } from "../app/dom.js";
import { later } from "../app/frames.js";
import { linkMass, valueAt } from "../scenario/values.js";

/** The keys whose value can be uncertain: stiffnesses, masses, delays. */
const KEYS = { "wall.contact.stiffness": "stiffness of the wall", "arm.link2.mass": "mass of link 2",
  "arm.link3.mass": "mass of link 3", "arm.payload.mass": "payload", "sampling.delay": "delay",
  "controller.stiffness": "stiffness of the controller" }; // prettier-ignore

export function startBand(store) {
  const boxes = new Map();
  const change = () => {
    const within = at("band-on").checked ? Number(at("band-within").value) / 100 : 0;
    const keys = [...boxes].filter(([, box]) => box.checked).map(([key]) => key);
    store.set({ band: { within: keys.length > 0 ? within : 0, keys } });
  };
  const offer = () => {
    const keys = Object.keys(KEYS).filter((key) => canVary(store.get("resolved"), key));
    if (keys.join() === [...boxes.keys()].join()) return;
    const off = [...boxes].filter(([, box]) => !box.checked).map(([key]) => key);
    boxes.clear();
    at("band-keys").replaceChildren(...keys.map((key) => {
      const box = make("input", { type: "checkbox", checked: !off.includes(key) });
      box.addEventListener("change", change);
      boxes.set(key, box);
      return make("label", { title: key }, box, ` ${KEYS[key]}`);
    })); // prettier-ignore
    change();
  };
  at("band-on").addEventListener("change", change);
  at("band-within").addEventListener("input", () => {
    at("band-value").textContent = `±${at("band-within").value} %`;
    change();
  });
  store.on(["resolved"], () => later("band", offer));
}

function canVary(resolved, key) {
  const link = /^arm\.(link[23])\.mass$/.exec(key);
  const value = link ? linkMass(resolved.arm[link[1]]) : valueAt(resolved, key);
  return typeof value === "number" && value > 0;
}
