/** A link that carries a scenario: its text, compressed, in the part of the address that no browser sends away. */

const KEY = "#s=";

/** Throws an Error where the page has no address of its own. */
export async function linkOf(text) {
  if (location.protocol === "about:") throw new Error("the cell of a notebook has no address; save the scenario instead");
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const letters = Array.from(bytes, (byte) => String.fromCharCode(byte)).join("");
  const code = btoa(letters).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
  return location.href.split("#")[0] + KEY + code;
}

/** The text that an address carries; null where it carries none, or one that is damaged. */
export async function textOf(hash) {
  if (!hash.startsWith(KEY)) return null;
  try {
    const letters = atob(hash.slice(KEY.length).replaceAll("-", "+").replaceAll("_", "/"));
    const bytes = Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
    return await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"))).text();
  } catch {
    return null; // the link was cut off on its way: the page starts as without it
  }
}
