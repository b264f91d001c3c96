/** When there is contact: shaded in the plots, with a line where it begins and where it ends. */

const MARKED_EVENTS = 4; // where there are more, the shade alone shows it

/** Intervals of contact, s; one that began before the first row begins with it, and an open one ends with the run. */
export function contactSpans({ columns, events }) {
  const { t, contact } = columns;
  const spans = [];
  let start = contact[0] > 0.5 && events[0]?.type !== "make" ? t[0] : null;
  for (const event of events) {
    if (event.type === "make") start ??= event.t;
    else if (start !== null) {
      spans.push([start, event.t]);
      start = null;
    }
  }
  if (start !== null) spans.push([start, t[t.length - 1]]);
  return spans;
}

/** A hook of uPlot that draws behind the curves. */
export function drawContact(plot, { spans, events, colour, ink }) {
  const { ctx, bbox } = plot;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.fillStyle = colour;
  for (const [start, end] of spans) {
    const left = plot.valToPos(start, "x", true);
    ctx.fillRect(left, bbox.top, Math.max(1, plot.valToPos(end, "x", true) - left), bbox.height);
  }
  if (events.length <= MARKED_EVENTS) {
    ctx.strokeStyle = ink;
    ctx.lineWidth = devicePixelRatio;
    for (const event of events) {
      ctx.setLineDash(event.type === "make" ? [2, 3] : [6, 3]);
      const x = Math.round(plot.valToPos(event.t, "x", true)) + 0.5;
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
    }
  }
  ctx.restore();
}
