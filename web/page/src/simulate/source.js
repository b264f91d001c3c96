/** Where worker and simulator come from: files beside the page, or texts in the page that opens from disk. */
import { given, unpacked } from "../app/given.js";

/** { wasm: bytes, makeWorker: function }. */
export async function source() {
  const held = given("arm3r-core");
  if (!held) {
    const response = await fetch("arm3r.wasm");
    if (!response.ok) throw new Error(`arm3r.wasm: ${response.status} ${response.statusText}`);
    return { wasm: await response.arrayBuffer(), makeWorker: () => new Worker("worker.js") };
  }
  const [wasm, script] = await Promise.all([unpacked(held.wasm), unpacked(held.worker)]);
  const url = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
  return { wasm, makeWorker: () => new Worker(url) };
}
