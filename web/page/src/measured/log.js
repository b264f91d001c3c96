/** Reads a measurement: a text of named columns over time, named as those of a run. */
import { DEGREE } from "../app/numbers.js";

const COMMENT = /^\s*[#%]/;
const SLICE = 5; // ms after which the page draws a frame while a long file is read
const UNITS = [["deg", "rad", DEGREE], ["mm", "m", 1e-3]]; // taken where a run has the second one

/**
 * A promise of { name, columns: { name: { t, values } }, others }: the rows in which a column has a number, SI units and
 * radians; others: names of columns that a run does not have.
 *
 * name: of the file. units: of the columns of the run, by name. Throws an Error that names file, line, column and value.
 */
export async function readLog(text, name, units) {
  const lines = text.replace(/^\uFEFF/, "").split(/\r?\n/);
  const rows = lines.map((line, i) => [i + 1, line]).filter(([, line]) => line.trim() && !COMMENT.test(line));
  if (rows.length < 3) throw new Error(`${name}: a line of names and at least two rows of numbers are needed, got ${rows.length} lines`);
  const separator = [";", "\t", ","].reduce((a, b) => (count(rows[0][1], b) > count(rows[0][1], a) ? b : a));
  const head = rows[0][1].split(separator).map((cell) => meant(unquoted(cell), units));
  checkNames(name, rows[0][0], head);
  const numbers = await numbersOf(rows.slice(1), { name, head, separator });
  const t = numbers[head.findIndex((one) => one.known === "t")];
  const back = t.findIndex((time, i) => !Number.isFinite(time) || time < t[i - 1]);
  if (back >= 0) throw new Error(`${name}:${rows[back + 1][0]}: time is a number that does not decrease, got ${t[back]}`);
  const measured = head.flatMap(({ known }, k) => (known && known !== "t" ? [[known, withNumbers(t, numbers[k])]] : []));
  return { name, columns: Object.fromEntries(measured), others: head.filter((one) => !one.known).map((one) => one.given) };
}

/** An array for each column that is known. rows: each with the number of its line. */
async function numbersOf(rows, { name, head, separator }) {
  const numbers = head.map((one) => (one.known ? new Float64Array(rows.length) : null));
  let since = performance.now();
  for (let i = 0; i < rows.length; i += 1) {
    const where = `${name}:${rows[i][0]}`;
    const cells = rows[i][1].split(separator);
    if (cells.length !== head.length) throw new Error(`${where}: a row has ${head.length} cells as the first line has, got ${cells.length}`);
    head.forEach(({ known, given, factor }, k) => {
      if (known) numbers[k][i] = factor * numberOf(cells[k], separator, `${where}: ${given}`);
    });
    if (performance.now() - since > SLICE) {
      await new Promise(requestAnimationFrame);
      since = performance.now();
    }
  }
  return numbers;
}

function withNumbers(t, values) {
  const has = (_, i) => Number.isFinite(values[i]);
  return { t: t.filter(has), values: values.filter(has) };
}

function checkNames(name, line, head) {
  const names = head.map((one) => one.known).filter(Boolean);
  const given = head.map((one) => one.given).join(", ").slice(0, 80);
  if (!names.includes("t")) throw new Error(`${name}:${line}: a column t or time, in s, is needed, got ${given}`);
  const twice = names.find((one, i) => names.indexOf(one) < i);
  if (twice) throw new Error(`${name}:${line}: each column is needed once, got ${twice} twice`);
  if (names.length < 2) {
    throw new Error(`${name}:${line}: no column has a name that the run has, such as q1 or tip_x, got ${given}; the button Rows (CSV) writes the names of all`);
  }
}

/** What a column is called in a run (`known`), and the factor to its unit: "q1 [deg]" is q1. */
function meant(given, units) {
  const [, bare, unit] = /^(.*?)\s*(?:[[(](.*)[\])])?$/.exec(given);
  const known = bare === "time" ? "t" : bare;
  if (!(known in units)) return { given };
  const own = units[known];
  if (unit === undefined || unit === own) return { given, known, factor: 1 };
  const other = UNITS.find(([from, to]) => unit.replace(from, to) === own && unit.includes(from));
  return other ? { given, known, factor: other[2] } : { given };
}

/** The number in a cell; NaN where it is empty. */
function numberOf(cell, separator, where) {
  const text = unquoted(separator === "," ? cell : cell.replace(",", "."));
  const value = text === "" || /^nan$/i.test(text) ? NaN : Number(text);
  if (Number.isNaN(value) && text !== "" && !/^nan$/i.test(text)) throw new Error(`${where} is a number, got ${text.slice(0, 80)}`);
  return value;
}

function unquoted(cell) {
  return cell.trim().replace(/^"(.*)"$/, "$1").trim();
}

function count(text, letter) {
  return text.split(letter).length;
}
