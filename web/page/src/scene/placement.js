/** Where a label finds room near its point, without covering lines and boxes. All in px. */

const DISTANCES = [6, 16, 30, 48, 70, 96, 130]; // of a label from its point
const COUNT = 16; // directions
const DIRECTIONS = Array.from({ length: COUNT }, (_, i) => [Math.cos((2 * Math.PI * i) / COUNT), Math.sin((2 * Math.PI * i) / COUNT)]);
const WORTH = 2; // distances by which a place must be nearer for a label to leave its own

/**
 * The nearest free place: { place: its number, box }; null where there is none. A label keeps the place that it has, so
 * that it rests beside a point that moves, until one is free that is much nearer.
 *
 * point: [x, y]. size: width and height of the label. away: [x, y], the direction that is tried first. place: number of the
 * place that it has, -1 for none. area: the box that it lies in. boxes: [left, top, right, bottom] each. lines: [x, y, x, y,
 * half their thickness] each.
 */
export function freePlace({ point, size, away, place }, { area, boxes, lines }) {
  const isFree = (box) => isInside(box, area) && !boxes.some((other) => overlap(box, other)) && !lines.some((line) => crosses(line, box));
  const own = place < 0 ? null : { place, box: boxAt(place, point, size) };
  const stays = Boolean(own) && isFree(own.box);
  const most = stays ? Math.floor(place / COUNT) - WORTH : DISTANCES.length - 1;
  const order = DIRECTIONS.map((_, j) => j).sort((a, b) => dot(DIRECTIONS[b], away) - dot(DIRECTIONS[a], away));
  for (let i = 0; i <= most; i += 1) {
    for (const j of order) {
      const box = boxAt(COUNT * i + j, point, size);
      if (isFree(box)) return { place: COUNT * i + j, box };
    }
  }
  return stays ? own : null;
}

function boxAt(place, [x, y], [width, height]) {
  const distance = DISTANCES[Math.floor(place / COUNT)];
  const [right, down] = DIRECTIONS[place % COUNT];
  const [left, top] = [x + right * (distance + width / 2) - width / 2, y + down * (distance + height / 2) - height / 2];
  return [left, top, left + width, top + height];
}

function isInside([left, top, right, bottom], area) {
  return left >= area[0] && top >= area[1] && right <= area[2] && bottom <= area[3];
}

function overlap(a, b) {
  return a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
}

/** Whether a line meets a box, both as thick as they are (Liang and Barsky). */
function crosses([x1, y1, x2, y2, half], [left, top, right, bottom]) {
  let [from, to] = [0, 1];
  const sides = [[x1 - x2, x1 - left + half], [x2 - x1, right + half - x1], [y1 - y2, y1 - top + half], [y2 - y1, bottom + half - y1]]; // prettier-ignore
  for (const [step, room] of sides) {
    if (step === 0 && room < 0) return false;
    if (step < 0) from = Math.max(from, room / step);
    if (step > 0) to = Math.min(to, room / step);
  }
  return from <= to;
}

function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1];
}
