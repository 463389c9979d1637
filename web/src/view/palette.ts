// The colours of the project's pictures.

export const CARBON = "#2b2f36";
export const METAL = "#8d949e";
export const SHELL = "#d9dce0";
export const WOOD = "#c2853f";
export const FRONT = "#e8641b"; // the rotors of a quadrotor's front half, to show its heading
export const REAR = "#2f6fb0";
export const JOINT = "#f0b429";
export const GUARD = "#5b636e";
export const PUSH = "#d5281b";
export const HAND = "#7a3fb5";
export const PATH = "#1f5fbf";
export const FLOOR = "#d3d7db";
export const PALE = "#d9dee2"; // floor and sky of light graphics
export const LANE = "#e3e6e9";
export const GRID = "#a9b1ba";
export const HAZE = "#e9edf1";
export const ZENITH = "#b4cbe1";
export const WALL = "#7f8fa3";
export const FRAME = "#4d5a6b";
export const WIND = "#2a93b8";
export const SHADE = "#aeb5bd";
