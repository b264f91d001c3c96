/** Fewer rows of long columns, so that a plot looks the same: of each stretch the rows of the extremes are kept. */

/**
 * The numbers of the rows to draw between two rows: all of them where they are few, else at most about `most`.
 *
 * columns: arrays of one length that are drawn together.
 */
export function thin(columns, from, to, most = 1600) {
  const count = to - from;
  if (count <= most) return Int32Array.from({ length: count }, (_, i) => from + i);
  const stretches = Math.max(1, Math.floor(most / (2 * columns.length)));
  const kept = new Set([from, to - 1]);
  for (let k = 0; k < stretches; k += 1) {
    const start = from + Math.floor((k * count) / stretches);
    const end = from + Math.floor(((k + 1) * count) / stretches);
    for (const column of columns) keepExtremes(column, start, end, kept);
  }
  return Int32Array.from(kept).sort();
}

function keepExtremes(column, start, end, kept) {
  let low = start;
  let high = start;
  for (let i = start + 1; i < end; i += 1) {
    if (column[i] < column[low]) low = i;
    if (column[i] > column[high]) high = i;
  }
  kept.add(low).add(high);
}

/** The values of some rows of a column, times a factor. */
export function picked(column, rows, scale = 1) {
  const values = new Float64Array(rows.length);
  for (let i = 0; i < rows.length; i += 1) values[i] = scale * column[rows[i]];
  return values;
}

/** The number of the last row not after a time. */
export function rowAt(t, time) {
  let low = 0;
  let high = t.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (t[middle] <= time) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** A column at a time, straight between rows. */
export function valueOf(t, column, time) {
  return valuesOf(t, column, time)[0];
}

/** Rows of several numbers, one after the other in an array, at a time, straight between rows: those of one row. */
export function valuesOf(t, numbers, time) {
  const width = numbers.length / t.length;
  const i = rowAt(t, time);
  const row = numbers.slice(width * i, width * (i + 1));
  if (i >= t.length - 1) return row;
  const share = Math.min(1, Math.max(0, (time - t[i]) / (t[i + 1] - t[i])));
  return row.map((value, j) => value + share * (numbers[width * (i + 1) + j] - value));
}
