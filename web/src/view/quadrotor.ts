// One quadrotor: hull, arms, motors, guard and legs, in body axes of the whole vehicle.

import type { BufferGeometry } from "three";

import type { SceneQuadrotor } from "../wire/messages.generated.ts";
import { FRONT, JOINT, METAL, REAR, SHELL, palette } from "./palette.ts";
import { at, ball, box, lathe, type Place, ring, rod, strut } from "./shapes.ts";

const POSTS = 12; // of a guard

/** Whether a rotor is in front of its quadrotor's centre. */
export function ahead(quadrotor: SceneQuadrotor, rotor: number): boolean {
  return quadrotor.rotors[rotor].position[0] > quadrotor.position[0] + 1e-6;
}

/** Height of a rotor's disc in body axes: above the arms, even if the mission has it at the centre's height. */
export function hubHeight(quadrotor: SceneQuadrotor, rotor: number): number {
  return Math.max(quadrotor.rotors[rotor].position[2], quadrotor.position[2] + 0.2 * quadrotor.arm);
}

export function quadrotorParts(quadrotor: SceneQuadrotor, sides: number): BufferGeometry[] {
  const size = quadrotor.arm;
  const center = at(...quadrotor.position);
  const hull = shell(size, sides).map((part) => part.translate(center.x, center.y, center.z));
  return [...hull, ...arms(quadrotor, size, sides), ...guard(quadrotor, size, sides), ...legs(quadrotor, size, sides)];
}

/** A rounded body with a dark band, a battery below, and a nose that points ahead. */
function shell(size: number, sides: number): BufferGeometry[] {
  const steps = sides > 10 ? 14 : sides;
  const profile = Array.from({ length: steps + 1 }, (_, i): [number, number] => {
    const turn = -Math.PI / 2 + (Math.PI * i) / steps;
    return [0.42 * Math.sqrt(Math.max(Math.cos(turn), 0)) * size, (0.2 * Math.sin(turn) + 0.03) * size];
  });
  const band: [number, number][] = [
    [0.43 * size, -0.02 * size],
    [0.43 * size, 0.05 * size],
  ];
  const nose = rod(
    at(0.36 * size, 0, 0.03 * size),
    at(0.52 * size, 0, 0.03 * size),
    0.1 * size,
    palette.carbon,
    sides,
    0.06 * size,
  );
  const lens = ball(at(0.52 * size, 0, 0.03 * size), 0.06 * size, "#15181d", sides);
  const battery = box(at(0, 0, -0.2 * size), [0.5 * size, 0.26 * size, 0.12 * size], palette.carbon);
  const light = ball(at(-0.2 * size, 0, 0.2 * size), 0.035 * size, JOINT, sides);
  return [lathe(profile, SHELL, sides), lathe(band, palette.carbon, sides), nose, lens, battery, light];
}

/** Booms out to the guard, with a motor and a coloured hub under each rotor. */
function arms(quadrotor: SceneQuadrotor, size: number, sides: number): BufferGeometry[] {
  const center = at(...quadrotor.position);
  const reach = quadrotor.guard;
  return quadrotor.rotors.flatMap(({ position }, i) => {
    const foot = at(position[0], position[1], center.z);
    const outward = foot.clone().sub(center).normalize();
    const color = ahead(quadrotor, i) ? FRONT : REAR;
    const hub = hubHeight(quadrotor, i);
    return [
      strut(center, center.clone().addScaledVector(outward, reach), 0.05 * size, palette.carbon, sides),
      rod(lifted(foot, -0.05 * size), at(foot.x, foot.y, hub - 0.08 * size), 0.1 * size, METAL, sides),
      rod(at(foot.x, foot.y, hub - 0.08 * size), at(foot.x, foot.y, hub), 0.085 * size, palette.carbon, sides),
      rod(at(foot.x, foot.y, hub), at(foot.x, foot.y, hub + 0.05 * size), 0.05 * size, color, sides, 0.025 * size),
    ];
  });
}

/** Two rings around all rotors, held apart by posts. */
function guard(quadrotor: SceneQuadrotor, size: number, sides: number): BufferGeometry[] {
  const center = at(...quadrotor.position);
  const radius = quadrotor.guard;
  const [low, high] = [lifted(center, 0.02 * size), lifted(center, 0.26 * size)];
  const posts = Array.from({ length: POSTS }, (_, i) => {
    const turn = (2 * Math.PI * i) / POSTS;
    const way = at(radius * Math.cos(turn), radius * Math.sin(turn), 0);
    return strut(low.clone().add(way), high.clone().add(way), 0.013 * size, palette.guard, Math.min(sides, 5));
  });
  return [ring(low, radius, 0.035 * size, palette.guard, sides), ring(high, radius, 0.018 * size, palette.guard, sides), ...posts];
}

function legs(quadrotor: SceneQuadrotor, size: number, sides: number): BufferGeometry[] {
  const center = at(...quadrotor.position);
  const across = quadrotor.feet.spread;
  const depth = quadrotor.feet.depth;
  const corners: [number, number][] = [
    [1, 1],
    [-1, 1],
    [-1, -1],
    [1, -1],
  ];
  return corners.flatMap(([x, y]) => {
    const foot = at(across * x, across * y, 0.05 * size - depth).add(center);
    const knee = at(0.5 * across * x, 0.5 * across * y, -0.05 * size).add(center);
    return [strut(knee, foot, 0.03 * size, palette.carbon, sides), ball(foot, 0.05 * size, palette.carbon, sides)];
  });
}

function lifted(place: Place, height: number): Place {
  return at(place.x, place.y, place.z + height);
}
