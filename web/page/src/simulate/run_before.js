/** Keeps the run before the last change, to compare with. */

const ONE_CHANGE = 1000; // ms: runs that follow each other faster are of one change, as are those while a pointer is pressed

export function keepRunBefore(store) {
  let last = { run: null, opened: null, came: -Infinity }; // came: when, ms
  let pressed = Infinity; // since when a pointer is pressed, ms
  document.addEventListener("pointerdown", () => (pressed = performance.now()), true);
  for (const kind of ["pointerup", "pointercancel"]) document.addEventListener(kind, () => (pressed = Infinity), true);
  store.on(["run"], () => {
    const [run, opened, now] = [store.get("run"), store.get("opened"), performance.now()];
    const isFirst = opened !== last.opened; // of its scenario
    if (isFirst) store.set({ before: null });
    else if (now - last.came > ONE_CHANGE && last.came < pressed) store.set({ before: last.run });
    last = { run, opened, came: isFirst ? -Infinity : now };
  });
}
