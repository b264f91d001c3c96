/** From where to where a slider goes: around the scenario's value, as far as people vary it and the schema allows. */
import { DEGREE } from "../app/numbers.js";

const STEPS = 1000; // positions of a slider

/**
 * { low, high, logarithmic, integer } of the slider of a number; angles are in degrees.
 *
 * key: as keyOf describes it. value: the scenario's.
 */
export function rangeOf(key, value) {
  const scale = isAngle(key) ? 1 / DEGREE : 1;
  const { low, high, logarithmic } = wanted(key, value);
  const clipped = { low: Math.max(low, key.minimum), high: Math.min(high, key.maximum) };
  return { low: scale * clipped.low, high: scale * clipped.high, logarithmic, integer: key.integer };
}

export function isAngle(key) {
  return key.unit === "rad" || key.unit === "rad/s";
}

function wanted(key, value) {
  const { zero, factor, signed, turn } = key.usual;
  if (turn) return { low: -Math.PI, high: Math.PI, logarithmic: false };
  if (signed) {
    const size = value === 0 ? zero : 2 * Math.abs(value);
    return { low: -size, high: size, logarithmic: false };
  }
  if (value <= 0 || key.integer || key.unit === "samples") {
    return { low: Math.max(0, key.minimum), high: Math.max(2 * value, zero), logarithmic: false };
  }
  return { low: value / factor, high: value * factor, logarithmic: true };
}

/** Where a slider of 0 to STEPS stands for a number. */
export function position({ low, high, logarithmic }, value) {
  const share = logarithmic ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  return Math.round(STEPS * Math.min(1, Math.max(0, share)));
}

/** The number for which a slider stands, with as many digits as people read. */
export function numberAt({ low, high, logarithmic, integer }, place) {
  const share = place / STEPS;
  const value = logarithmic ? low * (high / low) ** share : low + share * (high - low);
  if (integer) return Math.round(value);
  const digits = 10 ** (2 - Math.ceil(Math.log10(logarithmic ? value : high - low)));
  return clip(Math.round(value * digits) / digits, low, high);
}

function clip(value, low, high) {
  return Math.min(high, Math.max(low, value));
}
