/** From where to where a slider goes: around the scenario's value, within what the schema allows. */
import { DEGREE } from "../app/numbers.js";

const STEPS = 1000; // positions of a slider

/** How far a slider goes whose number is 0 in the scenario, by the end of its path; 1 where none is named. */
const USUAL = { noise: 2, delay: 30, mass: 3, armature: 0.1, resolution: 0.5, tool_mass: 2, coefficient: 1, tip: 0.3,
  damping: 2, friction: 2, cutoff: 200, contact_on: 5, contact_off: 5, force: 20, bias: 5, start: 5, rise: 2, seed: 50,
  face_offset: 0.3, base_height: 1, velocity_gain: 50, position_gain: 500, force_integral_gain: 20, force_gain: 2,
  velocity: 0.3, rate: 1, gravity: 10, q: Math.PI, qd: 3, point: 2, joint_damping: 20, stiffness: 1000, phase: Math.PI,
  offset: 0.3, shoulder_offset: 0.3 }; // prettier-ignore

/** Numbers that are as sensible below zero as above. */
const SIGNED = ["q", "qd", "point", "tip", "velocity", "gravity", "bias", "force", "phase", "distance", "face_offset",
  "torque", "q_amplitude", "tip_amplitude", "plane_point", "value", "initial", "amplitude", "base_height", "position",
  "offset", "shoulder_offset"]; // prettier-ignore

/** Factors by which a positive number goes down and up. */
const SPAN = { default: 30, length: 3, rate: 20, stop: 3, duration: 10, period: 10, radius: 5, forgetting: 1.05 };

/**
 * { low, high, logarithmic, integer } of the slider of a number; angles are in degrees.
 *
 * name: last part of the path. key: as keyOf describes it. value: the scenario's.
 */
export function rangeOf(name, key, value) {
  const scale = isAngle(key) ? 1 / DEGREE : 1;
  const { low, high, logarithmic } = wanted(name, key, value);
  const clipped = { low: Math.max(low, key.minimum), high: Math.min(high, key.maximum) };
  return { low: scale * clipped.low, high: scale * clipped.high, logarithmic, integer: key.integer };
}

export function isAngle(key) {
  return key.unit === "rad" || key.unit === "rad/s";
}

function wanted(name, key, value) {
  if (name === "q" || name === "rotation") return { low: -Math.PI, high: Math.PI, logarithmic: false };
  if (SIGNED.includes(name) && key.minimum < 0) {
    const size = Math.max(2 * Math.abs(value), value === 0 ? (USUAL[name] ?? 1) : 0);
    return { low: -size, high: size, logarithmic: false };
  }
  if (value <= 0 || key.integer || name === "delay") {
    return { low: Math.max(0, key.minimum), high: Math.max(2 * value, USUAL[name] ?? 1), logarithmic: false };
  }
  const span = SPAN[name] ?? SPAN.default;
  return { low: value / span, high: value * span, logarithmic: true };
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
