// What a person chooses about the hand by which the page pulls, and about pushes by keys.

export interface HandOptions {
  at: "point" | "centre"; // where the spring pulls: at the point that is held, or at the centre of mass
  plane: "facing" | "level"; // in which a drag moves the target
  planeChosen?: boolean; // by the person; else level in a challenge, where a drag upwards would leave the corridor
  kind: "push" | "shake" | "tap"; // what a drag of the beam and a key do
  frequency: number; // Hz, of a shake
  force: number; // N, of keys, gamepad and taps
  directions: "view" | "world"; // of keys and gamepad: as seen, or along the world's axes
}
