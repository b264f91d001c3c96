/**
 * What the page was given with its HTML: texts in script elements that no browser executes.
 *
 * `arm3r live` gives a scenario, `arm3r view` and `to_html` a run, the self-contained page its worker and simulator.
 */

/** The object in the script element with this id; null where there is none. */
export function given(id) {
  const element = document.getElementById(id);
  return element ? JSON.parse(element.textContent) : null;
}

/** The bytes of a gzip-compressed base64 text. */
export async function unpacked(base64) {
  const packed = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}
