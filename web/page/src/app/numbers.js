/** Numbers as people read them, and as YAML has them. */

/** With so many significant digits, a minus sign instead of a hyphen, and no exponent where that can be read. */
export function shown(value, digits = 4) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  const size = Math.abs(value);
  const text = size !== 0 && (size < 1e-4 || size >= 1e6) ? value.toExponential(digits - 1) : plain(value, digits);
  return text.replace("-", "−").replace(/e\+?(−|-)?/, (_, minus) => `e${minus ? "−" : ""}`);
}

function plain(value, digits) {
  const size = Math.abs(value);
  const before = size === 0 ? 1 : Math.floor(Math.log10(size)) + 1; // digits before the point; zeros behind it count as less
  return value.toFixed(Math.min(digits + 1, Math.max(0, digits - before)));
}

/** Rounded to significant digits: a number, such as a slider gives it. */
export function rounded(value, digits = 4) {
  return Number(value.toPrecision(digits));
}

/** As every YAML reader takes it for a number: with a point and a sign in front of an exponent. */
export function yaml(value) {
  if (!Number.isFinite(value)) return value > 0 ? "inf" : "-inf";
  const [digits, exponent] = String(value).split("e");
  if (exponent === undefined) return digits;
  return `${digits.includes(".") ? digits : `${digits}.0`}e${/^[+-]/.test(exponent) ? "" : "+"}${exponent}`;
}

export const DEGREE = Math.PI / 180;

/** ms for which a number stays while a run plays, so that it can be read. */
export const READABLE = 100;

/** An angle, rad, in degrees or radians. */
export function angleText(angle, degrees) {
  return degrees ? `${fixed(angle / DEGREE, 1)}°` : `${fixed(angle, 3)} rad`;
}

/** With so many digits behind the point; what is rounded to zero has no sign. */
export function fixed(value, digits) {
  return value.toFixed(digits).replace(/^-(?=0\.?0*$)/, "").replace("-", "−");
}
