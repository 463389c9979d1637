// The colours of what is drawn beside the vehicle, whose own come with its shapes.

export type Theme = "light" | "dark";

const LIGHT = {
  push: "#d5281b",
  contact: "#c47a00",
  moment: "#b4551c",
  person: "#b3bdc9",
  hand: "#7a3fb5",
  path: "#1f5fbf",
  wind: "#2a93b8",
  floor: "#d3d7db",
  pale: "#d9dee2", // floor and sky of light graphics
  lane: "#e3e6e9",
  grid: "#a9b1ba",
  haze: "#e9edf1",
  zenith: "#b4cbe1",
  wall: "#7f8fa3",
  frame: "#4d5a6b",
  shade: "#aeb5bd",
};

const DARK: typeof LIGHT = {
  push: "#ff5f52",
  contact: "#ffb938",
  moment: "#ff9a5c",
  person: "#76869a",
  hand: "#c08cff",
  path: "#6ea8ff",
  wind: "#4fc3e8",
  floor: "#262d35",
  pale: "#20272f",
  lane: "#303944",
  grid: "#56626f",
  haze: "#1d242c",
  zenith: "#0c1118",
  wall: "#6f8299",
  frame: "#9fb0c4",
  shade: "#11161b",
};

/** Colours of the vehicle that are too dark on a dark floor, and those in their place. */
const LIGHTER: Record<string, string> = { "#2b2f36": "#5c6672", "#5b636e": "#8b95a1" };

/** The colours that differ between the themes, as they are now; a picture takes them when it is built. */
export const palette = { ...LIGHT };

export function setPalette(theme: Theme): void {
  Object.assign(palette, theme === "dark" ? DARK : LIGHT);
}

/** A colour of the vehicle as it is drawn in the present theme. */
export function inTheme(color: string): string {
  return palette.floor === DARK.floor ? (LIGHTER[color] ?? color) : color;
}
