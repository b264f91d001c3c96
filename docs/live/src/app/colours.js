/** The colours of scene and plots: those of the figures of `arm3r-plot`, which colour-blind people can tell apart. */

export const BLUE = "#0072B2";
export const RED = "#D55E00";
export const GREEN = "#009E73";
export const AMBER = "#E69F00";
export const SKY = "#56B4E9";
export const PINK = "#CC79A7";

const LIGHT = {
  ink: "#222222", faint: "#6b7280", grid: "#e3e5e8", paper: "#ffffff", scene: "#f4f6f8", floor: "#c9ced6",
  link: "#8a94a3", joint: "#3b4350", contact: "rgba(230,159,0,0.16)", blue: BLUE, sky: "#2f7fb8",
};
const DARK = {
  ink: "#e6e8eb", faint: "#9aa3af", grid: "#333a44", paper: "#171b21", scene: "#12161b", floor: "#3a424d",
  link: "#9aa6b6", joint: "#5f6b7a", contact: "rgba(230,159,0,0.20)", blue: SKY, sky: BLUE,
};

/** The colours of a theme, "light" or "dark"; blue is a lighter one on a dark ground. */
export function colours(theme) {
  const base = theme === "dark" ? DARK : LIGHT;
  return { ...base, red: RED, green: GREEN, amber: AMBER, pink: PINK };
}
