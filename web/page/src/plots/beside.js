/**
 * Curves beside those of the run, in the same panel: what was measured, and what somebody draws.
 *
 * Each has low and high, in the unit of the panel; draw(plot, look); note(), an element for the panel's head; and
 * put(plot), called when there is a plot to be on.
 */

/** Draw a curve over a plot; times in s, values in the unit of the panel, straight between them. */
export function drawCurve(plot, times, values, { colour, width }) {
  const { ctx, bbox } = plot;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.setLineDash([]);
  ctx.strokeStyle = colour;
  ctx.lineWidth = width * devicePixelRatio;
  ctx.lineJoin = ctx.lineCap = "round";
  ctx.beginPath();
  for (let i = 0; i < times.length; i += 1) ctx.lineTo(plot.valToPos(times[i], "x", true), plot.valToPos(values[i], "y", true));
  ctx.stroke();
  ctx.restore();
}

/** [low, high] widened so that the curves fit, each with `low` and `high`. */
export function widened([low, high], curves) {
  return [Math.min(low, ...curves.map((one) => one.low)), Math.max(high, ...curves.map((one) => one.high))];
}
