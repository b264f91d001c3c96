/** A picture of the scene and the panels under it, as PNG. */
import { colours } from "../app/colours.js";
import { shown } from "../app/numbers.js";

const MARGIN = 24;
const LINE = 26;

/** A promise of the bytes of the picture. scene: null where the browser cannot draw one. */
export async function picture(store, scene, plots) {
  const look = colours(store.get("theme"));
  const drawn = [...(scene ? [["", scene.picture()]] : []), ...plots.pictures().map(([panel, canvas]) => [panelTitle(panel), canvas])];
  const width = Math.max(640, ...drawn.map(([, canvas]) => canvas.width));
  const heights = drawn.map(([title, canvas]) => (title ? LINE : 0) + (canvas.height * width) / canvas.width);
  const sheet = document.createElement("canvas");
  sheet.width = width + 2 * MARGIN;
  sheet.height = heights.reduce((sum, height) => sum + height + MARGIN, MARGIN + 2 * LINE);
  const pen = sheet.getContext("2d");
  pen.fillStyle = look.paper;
  pen.fillRect(0, 0, sheet.width, sheet.height);
  pen.fillStyle = look.ink;
  pen.font = "600 20px system-ui, sans-serif";
  pen.fillText(`${store.get("run").name}, t = ${shown(store.get("time"))} s`, MARGIN, MARGIN + LINE);
  pen.font = "15px system-ui, sans-serif";
  let top = MARGIN + 2 * LINE;
  drawn.forEach(([title, canvas], i) => {
    if (title) pen.fillText(title, MARGIN, top + LINE - 8);
    const own = (canvas.height * width) / canvas.width;
    pen.drawImage(canvas, MARGIN, top + (title ? LINE : 0), width, own);
    top += heights[i] + MARGIN;
  });
  return new Promise((resolve) => sheet.toBlob(resolve, "image/png"));
}

function panelTitle(panel) {
  return `${panel.title}, ${panel.unit}: ${panel.series.map((one) => one.label).join(", ")}`;
}
