/** The colours of scene and plots and what they mean: those of figures and films (python/arm3r_cpp/plot/style.py), which
 * colour-blind people can tell apart. */

export const BLACK = "#222222";
export const BLUE = "#0072B2";
export const RED = "#D55E00";
export const GREEN = "#009E73";
export const AMBER = "#E69F00";
export const SKY = "#56B4E9";
export const PINK = "#CC79A7";

export const ARM = "#8A94A3";
export const TIP = BLUE;
export const WALL = AMBER;
export const ON_WALL = RED; // forces; the pressing force is the normal part of that on the wall
export const ON_TIP = PINK;
export const REFERENCE = BLACK;
export const MEASURED = SKY;
export const JOINTS = [BLUE, RED, GREEN];

const LIGHT = {
  ink: REFERENCE, faint: "#6b7280", grid: "#e3e5e8", paper: "#ffffff", scene: "#f4f6f8", floor: "#c9ced6",
  link: ARM, joint: "#3b4350", contact: `${WALL}29`, blue: BLUE, tip: TIP,
};
const DARK = {
  ink: "#e6e8eb", faint: "#9aa3af", grid: "#333a44", paper: "#171b21", scene: "#12161b", floor: "#3a424d",
  link: "#9aa6b6", joint: "#5f6b7a", contact: `${WALL}33`, blue: SKY, tip: SKY,
};

/** The colours of a theme, "light" or "dark"; on a dark ground, black and blue are lighter. */
export function colours(theme) {
  const base = theme === "dark" ? DARK : LIGHT;
  return { ...base, red: RED, green: GREEN, amber: AMBER, sky: SKY, pink: PINK, wall: WALL, onWall: ON_WALL, measured: MEASURED };
}
